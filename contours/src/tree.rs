//! A tree of boxes, so that distant stretches are passed over together.

use crate::Bounds;

/// Boxes of the stretches and of their unions, in a flat binary tree: node `i` contains `2 i` and `2 i + 1`, the root is
/// node 1, the leaves are the second half, filled up with empty boxes to a power of two so that neighbours stay together.
#[derive(Debug)]
pub(crate) struct Tree {
    nodes: Vec<Bounds>,
    count: usize,
}

impl Tree {
    pub fn new(boxes: impl ExactSizeIterator<Item = Bounds>) -> Self {
        let count = boxes.len();
        let leaves = count.next_power_of_two();
        let mut nodes = vec![Bounds::EMPTY; leaves];
        nodes.extend(boxes);
        nodes.resize(2 * leaves, Bounds::EMPTY);
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].union(nodes[2 * node + 1]);
        }
        Self { nodes, count }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.nodes[1]
    }

    /// Calls `look` with the stretches that may be nearer to `(x, y)` than `limit`, nearer boxes first; `look` returns
    /// the new limit.
    pub fn visit(&self, x: f64, y: f64, limit: f64, look: &mut impl FnMut(usize) -> f64) {
        let mut limit = limit;
        let distance = self.nodes[1].distance(x, y);
        self.descend(1, distance, (x, y), &mut limit, look);
    }

    fn descend(
        &self,
        node: usize,
        distance: f64,
        point: (f64, f64),
        limit: &mut f64,
        look: &mut impl FnMut(usize) -> f64,
    ) {
        // A box that touches its stretch can round to a distance just above the stretch's own.
        if distance > *limit * (1.0 + 8.0 * f64::EPSILON) {
            return;
        }
        let leaves = self.nodes.len() / 2;
        if node >= leaves {
            if node - leaves < self.count {
                *limit = look(node - leaves);
            }
            return;
        }
        let far = |node: usize| self.nodes[node].distance(point.0, point.1);
        let (left, right) = (far(2 * node), far(2 * node + 1));
        if left <= right {
            self.descend(2 * node, left, point, limit, look);
            self.descend(2 * node + 1, right, point, limit, look);
        } else {
            self.descend(2 * node + 1, right, point, limit, look);
            self.descend(2 * node, left, point, limit, look);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_near_ones_are_looked_at() {
        for count in 1..40_usize {
            let boxes = (0..count).map(|k| Bounds::EMPTY.with(k as f64, 0.0));
            let tree = Tree::new(boxes);
            assert_eq!(tree.bounds().max[0], count as f64 - 1.0);
            let at = (count / 2) as f64 + 0.2;
            let mut seen = Vec::new();
            let mut best = f64::INFINITY;
            tree.visit(at, 0.0, best, &mut |k| {
                seen.push(k);
                best = best.min((k as f64 - at).abs());
                best
            });
            assert!(seen.contains(&(count / 2)) && seen.len() <= 3, "{seen:?}");
        }
    }
}
