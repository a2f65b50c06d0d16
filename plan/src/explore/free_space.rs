//! Where no object is, because the rod was there.

use super::Rectangle;
use rod_contact::ClampPath;

/// Side of a cell, rod lengths. The border of what is free is known to about a cell, and [`FreeSpace::allows`] keeps a cell away from it.
const CELL: f64 = 0.01;

/// Largest way (rod lengths) of a point of the rod from one state to the next along which it moves continuously. A longer one is a snap, which says nothing
/// about the space between.
const CONTINUOUS: f64 = 0.05;

/// The cells of the box around the object that the rod passed.
#[derive(Clone, Debug)]
pub(super) struct FreeSpace {
    bounds: Rectangle,
    /// m
    cell: f64,
    columns: usize,
    free: Vec<bool>,
}

impl FreeSpace {
    /// Nothing in the box is free yet; `length` is that of the rod, m.
    pub fn new(bounds: Rectangle, length: f64) -> Self {
        let cell = CELL * length;
        let [columns, rows] = [0, 1].map(|k| ((bounds.high[k] - bounds.low[k]) / cell).ceil().max(1.0) as usize);
        Self { bounds, cell, columns, free: vec![false; columns * rows] }
    }

    fn cell_of(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let column = ((x - self.bounds.low[0]) / self.cell).floor();
        let row = ((y - self.bounds.low[1]) / self.cell).floor();
        let is_inside = column >= 0.0 && row >= 0.0 && column < self.columns as f64;
        let cell = is_inside.then(|| row as usize * self.columns + column as usize)?;
        (cell < self.free.len()).then_some(cell)
    }

    /// The rod moved from one shape to the next, each of as many points, m. A rod of length `length` that jumps frees nothing.
    pub fn pass(&mut self, before: &[[f64; 2]], after: &[[f64; 2]], length: f64) {
        let apart = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        if before.iter().zip(after).any(|(a, b)| apart(*a, *b) > CONTINUOUS * length) {
            return;
        }
        let between = |a: [f64; 2], b: [f64; 2], share: f64| [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
        let parts = |way: f64| (2.0 * way / self.cell).ceil().max(1.0) as usize;
        for (one, other) in before.windows(2).zip(after.windows(2)) {
            let along = parts(apart(one[0], one[1]).max(apart(other[0], other[1])));
            let across = parts(apart(one[0], other[0]).max(apart(one[1], other[1])));
            for u in 0..=along {
                let share = u as f64 / along as f64;
                let [a, b] = [between(one[0], one[1], share), between(other[0], other[1], share)];
                for v in 0..=across {
                    if let Some(cell) = self.cell_of(between(a, b, v as f64 / across as f64)) {
                        self.free[cell] = true;
                    }
                }
            }
        }
    }

    /// Whether nothing can be where the clamp moves: outside the box, or a cell away from all that the rod has not passed.
    pub fn allows(&self, path: ClampPath) -> bool {
        let steps = (2.0 * path.length() / self.cell).ceil();
        (0..=steps as usize).all(|k| {
            let at = path.at(path.length() * k as f64 / steps);
            let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [f64::from(i), f64::from(j)]));
            let is_free = |[i, j]: [f64; 2]| {
                self.cell_of([at.x + i * self.cell, at.y + j * self.cell]).is_none_or(|cell| self.free[cell])
            };
            around.into_iter().all(is_free)
        })
    }

    /// Whether an object may be at a place: in the box, and not a cell or more within what the rod passed.
    pub fn may_be(&self, [x, y]: [f64; 2]) -> bool {
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [f64::from(i), f64::from(j)]));
        let mut near = around.map(|[i, j]| self.cell_of([x + i * self.cell, y + j * self.cell]));
        self.bounds.contains([x, y]) && near.any(|cell| cell.is_some_and(|cell| !self.free[cell]))
    }

    /// How far in a direction (rad) the nearest place is that the rod has not passed, m; none where it passed all.
    pub fn frontier(&self, angle: f64) -> Option<f64> {
        self.unknown().map(|[x, y]| x * angle.cos() + y * angle.sin()).reduce(f64::min)
    }

    /// The area (m^2) that the rod has not passed and that is nearer than `limit` (m) in a direction (rad).
    pub fn unknown_area(&self, angle: f64, limit: f64) -> f64 {
        let near = self.unknown().filter(|[x, y]| x * angle.cos() + y * angle.sin() < limit);
        near.count() as f64 * self.cell * self.cell
    }

    /// The centres of the cells that the rod has not passed.
    fn unknown(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.free.iter().enumerate().filter(|(_, free)| !**free).map(|(cell, _)| {
            let [column, row] = [cell % self.columns, cell / self.columns].map(|k| k as f64 + 0.5);
            [self.bounds.low[0] + column * self.cell, self.bounds.low[1] + row * self.cell]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::Pose;

    fn line(y: f64) -> ClampPath {
        let pose = |x: f64| Pose { x, y, phi: 1.5 };
        ClampPath::new(pose(-1.0), pose(2.0)).unwrap()
    }

    #[test]
    fn what_the_rod_passed_is_free_and_what_it_jumped_over_is_not() {
        let bounds = Rectangle { low: [0.0, 0.0], high: [1.0, 0.5] };
        let mut space = FreeSpace::new(bounds, 1.0);
        assert!(space.allows(line(-0.02)) && !space.allows(line(0.2)) && space.allows(line(0.6)));
        assert!((space.frontier(std::f64::consts::FRAC_PI_2).unwrap() - 0.005).abs() < 1e-12);
        let shape = |x: f64| [[x, -0.4], [x, 0.3]];
        (0..100).for_each(|k| space.pass(&shape(1.2 - 0.02 * f64::from(k)), &shape(1.18 - 0.02 * f64::from(k)), 1.0));
        assert!(space.allows(line(0.2)) && !space.allows(line(0.3)));
        assert!((space.frontier(std::f64::consts::FRAC_PI_2).unwrap() - 0.305).abs() < 0.011);
        let mut jumped = FreeSpace::new(bounds, 1.0);
        jumped.pass(&shape(1.2), &shape(-0.2), 1.0);
        assert!(!jumped.allows(line(0.2)));
    }
}
