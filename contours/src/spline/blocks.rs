//! Boxes around the cubics of a spline, so that distant ones are passed over together.

use std::ops::Range as Span;

use crate::Bounds;

/// Cubics in one box of the lowest level: few enough to look at each, and 16 bytes of boxes a cubic.
const BLOCK: usize = 4;

/// Boxes of blocks of cubics and of their unions: a binary tree in which a node over `n` blocks is followed by its left
/// half (`n / 2` blocks, hence `2 (n / 2) - 1` nodes) and then by its right half.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    nodes: Vec<Bounds>,
    cubics: usize,
}

/// A node with the blocks it covers.
#[derive(Clone, Copy)]
struct Node {
    index: usize,
    first: usize,
    end: usize,
}

impl Node {
    fn halves(self) -> [Self; 2] {
        let middle = self.first.midpoint(self.end);
        [
            Self { index: self.index + 1, end: middle, ..self },
            Self { index: self.index + 2 * (middle - self.first), first: middle, ..self },
        ]
    }

    fn is_block(self) -> bool {
        self.end == self.first + 1
    }

    /// What it and the span have in common, in cubics.
    fn within(self, span: &Span<usize>) -> Span<usize> {
        (BLOCK * self.first).max(span.start)..(BLOCK * self.end).min(span.end)
    }
}

/// What [`Blocks::visit`] looks for.
struct Visit<'a, F> {
    span: Span<usize>,
    point: (f64, f64),
    limit: f64,
    look: &'a mut F,
}

impl Blocks {
    /// The tree over so many cubics, at least one, with these boxes.
    pub fn new(cubics: usize, bounds: impl Fn(usize) -> Bounds) -> Self {
        let mut tree = Self { nodes: vec![Bounds::EMPTY; 2 * cubics.div_ceil(BLOCK) - 1], cubics };
        tree.fill(tree.root(), &bounds);
        tree
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.nodes[0]
    }

    /// Calls `look` with runs of cubics of the span that may be nearer to `(x, y)` than `limit`, nearer boxes first; `look`
    /// returns the new limit.
    pub fn visit(&self, span: Span<usize>, x: f64, y: f64, look: &mut impl FnMut(Span<usize>) -> f64) {
        let mut visit = Visit { span, point: (x, y), limit: f64::INFINITY, look };
        self.descend(self.root(), 0.0, &mut visit);
    }

    fn root(&self) -> Node {
        Node { index: 0, first: 0, end: self.cubics.div_ceil(BLOCK) }
    }

    fn fill(&mut self, node: Node, bounds: &impl Fn(usize) -> Bounds) -> Bounds {
        let union = if node.is_block() {
            node.within(&(0..self.cubics)).fold(Bounds::EMPTY, |union, cubic| union.union(bounds(cubic)))
        } else {
            let [left, right] = node.halves().map(|half| self.fill(half, bounds));
            left.union(right)
        };
        self.nodes[node.index] = union;
        union
    }

    fn descend<F: FnMut(Span<usize>) -> f64>(&self, node: Node, distance: f64, visit: &mut Visit<'_, F>) {
        let shared = node.within(&visit.span);
        if shared.is_empty() || beyond(distance, visit.limit) {
            return;
        }
        if node.is_block() {
            visit.limit = (visit.look)(shared);
            return;
        }
        let [left, right] = node.halves();
        let [to_left, to_right] =
            [left, right].map(|half| self.nodes[half.index].distance(visit.point.0, visit.point.1));
        if to_left <= to_right {
            self.descend(left, to_left, visit);
            self.descend(right, to_right, visit);
        } else {
            self.descend(right, to_right, visit);
            self.descend(left, to_left, visit);
        }
    }
}

/// Whether a box at this distance can be passed over: one that touches its curve may round to a distance just above the
/// curve's own.
pub(super) fn beyond(distance: f64, limit: f64) -> bool {
    distance > limit * (1.0 + 8.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_near_ones_of_the_span_are_looked_at() {
        for cubics in 1..80_usize {
            let tree = Blocks::new(cubics, |k| Bounds::EMPTY.with(k as f64, 0.0).with(k as f64 + 1.0, 0.0));
            assert_eq!(tree.bounds(), Bounds { min: [0.0, 0.0], max: [cubics as f64, 0.0] });
            for span in [0..cubics, cubics / 3..cubics, cubics / 2..cubics / 2 + 1] {
                for at in [-3.0, 0.37 * cubics as f64, cubics as f64 + 2.0] {
                    let mut seen = Vec::new();
                    let mut best = f64::INFINITY;
                    tree.visit(span.clone(), at, 0.0, &mut |run| {
                        for k in run {
                            seen.push(k);
                            best = best.min((k as f64 - at).max(at - k as f64 - 1.0).max(0.0));
                        }
                        best
                    });
                    let nearest = (at.max(0.0) as usize).clamp(span.start, span.end - 1);
                    assert!(seen.contains(&nearest) && seen.len() <= 2 * BLOCK, "{seen:?}");
                    assert!(seen.iter().all(|k| span.contains(k)), "{span:?} {seen:?}");
                }
            }
        }
    }
}
