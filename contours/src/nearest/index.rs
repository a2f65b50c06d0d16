//! Which of many boxes that follow each other along a contour are near.

use crate::Bounds;

/// Number of items up to which all are visited: a search for the near ones would cost more.
const FEW: usize = 6;

/// Number of boxes within one box of the next level. Fewer take more memory; with more, more boxes are compared.
const FAN: usize = 4;

/// Rounding of a squared distance, relative: the computed distance of a box may exceed that of the item which it touches.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Items by their boxes, and where they are many the boxes around each four of them, around each four of
/// those, and so on up to one: the parts of a contour, or many objects.
///
/// The items keep their order: what follows each other along a contour is together in space as well. An order by place
/// alone would pack different waves of a long wavy line together.
///
/// ```
/// use rod_contours::{Bounds, Index};
///
/// let row = (0..100).map(|k| Bounds { min: [k as f64, 0.0], max: [k as f64 + 0.5, 1.0] });
/// let index = Index::new(row);
/// let mut near = Vec::new();
/// index.meeting(Bounds { min: [41.2, 0.0], max: [42.1, 2.0] }, &mut |k| near.push(k));
/// assert_eq!(near, [41, 42]);
/// ```
#[derive(Clone, Debug)]
pub struct Index {
    count: usize,
    /// The boxes of the items, then those of each further level; nothing where there are few.
    boxes: Vec<Bounds>,
    /// Start of each level in `boxes`.
    levels: Vec<usize>,
    /// Items without finite boxes, in order; they are near everything, and stay out of the boxes around others. A contour
    /// has two at most.
    unbounded: Vec<usize>,
}

/// The query of [`Index::nearest`].
struct Nearest<'a, F> {
    x: f64,
    y: f64,
    /// The square of the distance beyond which nothing matters.
    limit: f64,
    /// The first item that matters and the one behind the last.
    among: [usize; 2],
    look: &'a mut F,
}

impl<F: FnMut(usize) -> f64> Nearest<'_, F> {
    fn look_at(&mut self, item: usize) {
        if item < self.among[0] || item >= self.among[1] {
            return;
        }
        let limit = (self.look)(item);
        self.limit = limit * limit * (1.0 + ROUNDING);
    }
}

impl Index {
    /// The index of items with these boxes.
    pub fn new(items: impl ExactSizeIterator<Item = Bounds>) -> Self {
        let count = items.len();
        if count <= FEW {
            return Self { count, boxes: Vec::new(), levels: Vec::new(), unbounded: Vec::new() };
        }
        let mut sizes = vec![count];
        while let Some(size) = sizes.last().filter(|size| **size > 1) {
            sizes.push(size.div_ceil(FAN));
        }
        let mut boxes = Vec::with_capacity(sizes.iter().sum());
        let mut unbounded = Vec::new();
        boxes.extend(items.enumerate().map(|(item, bounds)| {
            if bounds.is_finite() {
                return bounds;
            }
            unbounded.push(item);
            Bounds::EMPTY
        }));
        let mut levels = vec![0];
        for _ in 1..sizes.len() {
            let (from, to) = (levels[levels.len() - 1], boxes.len());
            levels.push(to);
            for first in (from..to).step_by(FAN) {
                let around = boxes[first..to.min(first + FAN)].iter().fold(Bounds::EMPTY, |all, one| all.union(*one));
                boxes.push(around);
            }
        }
        Self { count, boxes, levels, unbounded }
    }

    /// Whether all items are looked at anyway.
    pub fn is_small(&self) -> bool {
        self.levels.is_empty()
    }

    /// The box of an item; `None` if there are few items, or where it has no finite one.
    pub fn bounds(&self, item: usize) -> Option<Bounds> {
        (!self.is_small() && item < self.count && !self.unbounded.contains(&item)).then(|| self.boxes[item])
    }

    /// Calls `visit` with the items whose boxes meet `bounds`, and perhaps with others.
    pub fn meeting(&self, bounds: Bounds, visit: &mut impl FnMut(usize)) {
        match self.levels.len().checked_sub(1) {
            None => (0..self.count).for_each(visit),
            Some(top) => {
                self.unbounded.iter().copied().for_each(&mut *visit);
                self.descend_to(&bounds, top, 0, visit);
            }
        }
    }

    /// Calls `look` with the items that may be nearer to `(x, y)` than the limit it returned last, nearer boxes first.
    pub fn nearest(&self, x: f64, y: f64, look: &mut impl FnMut(usize) -> f64) {
        self.nearest_among([0, self.count], x, y, look);
    }

    /// [`nearest`](Self::nearest) among the items from the first number on, up to but without the second one.
    pub fn nearest_among(&self, among: [usize; 2], x: f64, y: f64, look: &mut impl FnMut(usize) -> f64) {
        match self.levels.len().checked_sub(1) {
            None => (among[0]..among[1]).for_each(|item| {
                look(item);
            }),
            Some(top) => {
                let mut nearest = Nearest { x, y, limit: f64::INFINITY, among, look };
                self.unbounded.iter().for_each(|item| nearest.look_at(*item));
                self.descend_near(&mut nearest, top, 0);
            }
        }
    }

    /// Number of the first box within one of a level above the lowest, and those boxes.
    fn within(&self, level: usize, number: usize) -> (usize, &[Bounds]) {
        let (from, to) = (self.levels[level - 1], self.levels[level]);
        let first = FAN * number;
        (first, &self.boxes[from + first..to.min(from + first + FAN)])
    }

    fn descend_to(&self, bounds: &Bounds, level: usize, number: usize, visit: &mut impl FnMut(usize)) {
        let (first, boxes) = self.within(level, number);
        for (number, _) in (first..).zip(boxes).filter(|(_, one)| one.meets(bounds)) {
            if level == 1 {
                visit(number);
            } else {
                self.descend_to(bounds, level - 1, number, visit);
            }
        }
    }

    fn descend_near<F: FnMut(usize) -> f64>(&self, nearest: &mut Nearest<'_, F>, level: usize, number: usize) {
        let (first, boxes) = self.within(level, number);
        let mut near = [(f64::INFINITY, 0); FAN];
        let mut count = 0;
        // how many items a box of this level holds
        let items = FAN.pow(level as u32 - 1);
        for (number, one) in (first..).zip(boxes) {
            if (number + 1) * items <= nearest.among[0] || number * items >= nearest.among[1] {
                continue;
            }
            let square = one.square_distance(nearest.x, nearest.y);
            if square > nearest.limit {
                continue;
            }
            let mut place = count;
            while place > 0 && near[place - 1].0 > square {
                near[place] = near[place - 1];
                place -= 1;
            }
            near[place] = (square, number);
            count += 1;
        }
        for &(square, number) in &near[..count] {
            if square > nearest.limit {
                return;
            }
            if level == 1 {
                nearest.look_at(number);
            } else {
                self.descend_near(nearest, level - 1, number);
            }
        }
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

    #[test]
    fn nothing_near_is_passed_over() {
        // A curve that comes back to itself again and again.
        let point = |k: usize| [(k as f64 * 0.031).sin() * 3.0, (k as f64 * 0.047).cos()];
        for count in [17, 63, 64, 65, 257, 1000] {
            let one = |k: usize| {
                let ([x, y], [u, v]) = (point(k), point(k + 1));
                Bounds::EMPTY.with(x, y).with(u, v)
            };
            let index = Index::new((0..count).map(one));
            for query in 0..200 {
                let [x, y] = point(7 * query + 3).map(|side| 1.3 * side + 0.1);
                let mut best = f64::INFINITY;
                index.nearest(x, y, &mut |k| {
                    best = best.min(one(k).distance(x, y));
                    best
                });
                let least = (0..count).map(|k| one(k).distance(x, y)).fold(f64::INFINITY, f64::min);
                assert_eq!(best, least, "{count} {query}");
                let around = Bounds::EMPTY.with(x, y).grown(0.2);
                let mut met = Vec::new();
                index.meeting(around, &mut |k| met.push(k));
                assert_eq!(met, (0..count).filter(|k| one(*k).meets(&around)).collect::<Vec<_>>());
            }
        }
    }
}
