//! The closest point of a contour, and what makes it fast: the search by samples, the parts on which it looks, and the index of many parts.

pub(crate) mod cuts;
mod index;
pub(crate) mod search;

pub use index::Index;

use crate::{Frame, Vector};

/// The point of a contour nearest to a given point, and how far away it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Parameter of the closest point.
    pub t: f64,
    /// Signed distance, a length: positive outside the solid.
    ///
    /// Where the closest point is an end of the range the sign is the side of the tangent there.
    pub gap: f64,
    /// The contour at `t`.
    pub frame: Frame,
    /// False when the closest point is an end of the range, where the foot need not be perpendicular.
    pub interior: bool,
}

impl Closest {
    /// The record for the point `(x, y)` with its closest point known to be at `t`.
    ///
    /// In the interior the gap is the projection on the outward normal: near the contour its absolute error is that of
    /// the coordinates, where the length of the difference would also carry the error of `t`.
    ///
    /// ```
    /// use rod_contours::{Closest, Frame};
    ///
    /// let floor = Frame { x: 0.0, y: 0.0, alpha: 0.0, speed: 1.0, turning: 0.0 };
    /// assert_eq!(Closest::new(0.0, floor, true, 0.0, -2.0).gap, 2.0); // solid above, point below
    /// assert_eq!(Closest::new(0.0, floor, false, 3.0, 4.0).gap, -5.0);
    /// ```
    pub fn new(t: f64, frame: Frame, interior: bool, x: f64, y: f64) -> Self {
        let (ahead, outside) = frame.local(x, y);
        Self { t, gap: gap(interior, outside, [ahead, outside]), frame, interior }
    }
}

/// The gap of a point that is `outside` along the outward normal of its closest one: in the interior that, else the
/// length of the way between the two, with the side of the tangent as its sign; the tangent itself is outside.
pub(crate) fn gap(interior: bool, outside: f64, [dx, dy]: Vector) -> f64 {
    match (interior, outside < 0.0) {
        (true, _) => outside,
        (false, false) => dx.hypot(dy),
        (false, true) => -dx.hypot(dy),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_ahead_of_an_end_is_outside() {
        let end = Frame { x: 0.0, y: 0.0, alpha: 0.0, speed: 1.0, turning: 0.0 };
        assert_eq!(Closest::new(1.0, end, false, 2.0, 0.0).gap, 2.0);
        assert_eq!(Closest::new(1.0, end, false, 2.0, -0.0).gap, 2.0);
    }
}
