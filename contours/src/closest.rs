//! The point of a contour that is nearest to a given point.

use crate::Frame;

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
        let gap = if interior { outside } else { ahead.hypot(outside).copysign(side(outside)) };
        Self { t, gap, frame, interior }
    }
}

/// The side as a sign; on the tangent itself counts as outside, whatever the sign of the zero.
fn side(outside: f64) -> f64 {
    if outside < 0.0 { -1.0 } else { 1.0 }
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
