//! Which of many boxes are near: the seam to `static_aabb2d_index`.

use static_aabb2d_index::{Control, StaticAABB2DIndex, StaticAABB2DIndexBuilder};

use crate::Bounds;

/// Up to so many items are all looked at: that costs less than to ask which ones are near.
const FEW: usize = 16;

/// Items by their boxes: a packed Hilbert R-tree where they are many.
#[derive(Debug)]
pub(crate) struct Index {
    count: usize,
    /// None where there are few.
    tree: Option<StaticAABB2DIndex<f64>>,
    /// Items without finite boxes, in order; they are near everything. A contour has two at most.
    unbounded: Vec<usize>,
}

impl Index {
    pub fn new(boxes: impl ExactSizeIterator<Item = Bounds> + Clone) -> Self {
        let count = boxes.len();
        if count <= FEW {
            return Self { count, tree: None, unbounded: Vec::new() };
        }
        let unbounded: Vec<usize> =
            boxes.clone().enumerate().filter(|(_, bounds)| !bounds.is_finite()).map(|(item, _)| item).collect();
        let mut builder = StaticAABB2DIndexBuilder::new(count - unbounded.len());
        for bounds in boxes.filter(Bounds::is_finite) {
            builder.add(bounds.min[0], bounds.min[1], bounds.max[0], bounds.max[1]);
        }
        // It fails only where fewer boxes were added than announced.
        Self { count, tree: builder.build().ok(), unbounded }
    }

    /// Whether all items are looked at anyway.
    pub fn is_small(&self) -> bool {
        self.tree.is_none()
    }

    /// Number of the item that is number `id` in the tree, which the unbounded ones are missing from.
    fn item(&self, id: usize) -> usize {
        self.unbounded.iter().fold(id, |item, unbounded| item + usize::from(*unbounded <= item))
    }

    /// Calls `visit` with the items whose boxes meet `bounds`, and perhaps with others.
    pub fn meeting(&self, bounds: Bounds, visit: &mut impl FnMut(usize)) {
        let Some(tree) = &self.tree else {
            (0..self.count).for_each(visit);
            return;
        };
        self.unbounded.iter().copied().for_each(&mut *visit);
        let [[left, low], [right, high]] = [bounds.min, bounds.max];
        tree.visit_query(left, low, right, high, &mut |id: usize| visit(self.item(id)));
    }

    /// Calls `look` with the items that may be nearer to `(x, y)` than the limit it returned last, nearer boxes first.
    pub fn nearest(&self, x: f64, y: f64, look: &mut impl FnMut(usize) -> f64) {
        let Some(tree) = &self.tree else {
            (0..self.count).for_each(|item| {
                look(item);
            });
            return;
        };
        let mut limit = f64::INFINITY;
        for &item in &self.unbounded {
            limit = look(item);
        }
        tree.visit_neighbors(x, y, &mut |id: usize, square: f64| {
            // A box that touches its item can round to a distance just above the item's own.
            if square.sqrt() > limit * (1.0 + 8.0 * f64::EPSILON) {
                return Control::Break(());
            }
            limit = look(self.item(id));
            Control::Continue
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_near_ones_are_looked_at() {
        for count in [1, 16, 17, 40, 1000_usize] {
            for unbounded in [false, true] {
                let boxes = (0..count).map(|k| {
                    if unbounded && (k == 0 || k == count - 1) {
                        Bounds::ALL
                    } else {
                        Bounds::EMPTY.with(k as f64, 0.0)
                    }
                });
                let index = Index::new(boxes);
                let at = (count / 2) as f64 + 0.2;
                let mut seen = Vec::new();
                let mut best = f64::INFINITY;
                index.nearest(at, 0.0, &mut |k| {
                    seen.push(k);
                    best = best.min((k as f64 - at).abs());
                    best
                });
                assert!(seen.contains(&(count / 2)), "{count}: {seen:?}");
                let mut met = Vec::new();
                index.meeting(Bounds::EMPTY.with(at - 1.0, 0.0).with(at + 1.0, 0.0), &mut |k| met.push(k));
                assert!(met.contains(&(count / 2)), "{count}: {met:?}");
                assert!(index.is_small() || (seen.len() <= 4 && met.len() <= 4), "{seen:?} {met:?}");
                assert_eq!(index.is_small(), count <= FEW);
            }
        }
    }
}
