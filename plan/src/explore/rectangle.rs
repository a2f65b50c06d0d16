//! Rectangles along the axes.

/// A rectangle along the axes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Smallest x and y.
    pub low: [f64; 2],
    /// Largest x and y.
    pub high: [f64; 2],
}

impl Rectangle {
    /// Whether a point is in it, its border included.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        self.low[0] <= x && x <= self.high[0] && self.low[1] <= y && y <= self.high[1]
    }

    /// The corners, counter-clockwise.
    pub fn corners(&self) -> [[f64; 2]; 4] {
        let ([a, b], [c, d]) = (self.low, self.high);
        [[a, b], [c, b], [c, d], [a, d]]
    }

    /// Whether it has finite sides that are longer than 0.
    pub(super) fn is_proper(&self) -> bool {
        (0..2).all(|k| self.low[k].is_finite() && self.high[k].is_finite() && self.low[k] < self.high[k])
    }

    /// How far it extends in a direction (rad), from where to where, m.
    pub(super) fn extent(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let along = self.corners().map(|[x, y]| x * cos + y * sin);
        (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }
}
