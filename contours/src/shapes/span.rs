//! The angle that an arc covers, in either sense, a full turn at most.

use std::f64::consts::TAU;

use crate::point::nearest_turn;
use crate::{ContourError, Range};

/// Excess of an arc over a full turn, relative to its angles, that is rounding of `from + TAU`.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// From one angle (rad) to another: up is counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub from: f64,
    pub to: f64,
}

impl Span {
    /// Checked: finite, not empty, at most a full turn.
    pub fn new(what: &'static str, from: f64, to: f64) -> Result<Self, ContourError> {
        let angle = (to - from).abs();
        if angle > 0.0 && angle <= TAU + ROUNDING * from.abs().max(to.abs()) {
            Ok(Self { from, to })
        } else {
            Err(ContourError::ArcAngle { what, from, to })
        }
    }

    /// 1 counterclockwise, -1 clockwise.
    pub fn sign(&self) -> f64 {
        if self.to > self.from { 1.0 } else { -1.0 }
    }

    /// The angle travelled in all, rad.
    pub fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// The angle (rad) where `t` of `radius * length` has been travelled; both ends come out exactly.
    pub fn at(&self, t: f64, radius: f64) -> f64 {
        let length = radius * self.length();
        if t <= 0.5 * length {
            self.from + self.sign() * (t / radius)
        } else {
            self.to - self.sign() * ((length - t) / radius)
        }
    }

    /// How far (rad) one has travelled at the angle, of all the times it is passed the one nearest to the middle of
    /// `range`, at most half a turn away from it.
    pub fn travelled(&self, angle: f64, range: Range) -> f64 {
        nearest_turn(self.sign() * (angle - self.from), 0.5 * (range.from + range.to))
    }

    /// Whether the angle is passed within `range`, by the angle travelled.
    pub fn passes(&self, angle: f64, range: Range) -> bool {
        range.contains(self.travelled(angle, range))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_found_in_whichever_turn() {
        let span = Span::new("the arc", 7.0, 5.0).unwrap();
        let range = Range { from: 0.0, to: 2.0 };
        assert!((span.travelled(6.0 - 3.0 * TAU, range) - 1.0).abs() < 1e-14);
        assert!(span.passes(0.0, range) && !span.passes(4.9, range));
        assert_eq!((span.at(0.0, 0.1), span.at(0.2, 0.1)), (7.0, 5.0));
    }

    #[test]
    fn a_full_turn_from_anywhere_is_accepted() {
        for k in 0..1000 {
            let from = f64::from(k) * 0.377 - 100.0;
            assert!(Span::new("the arc", from, from + TAU).is_ok());
            assert!(Span::new("the arc", from, from - TAU).is_ok());
            assert!(Span::new("the arc", from, from + TAU + 1e-12).is_err());
        }
        assert!(Span::new("the arc", 1.0, 1.0).is_err());
        assert!(Span::new("the arc", 1.0, f64::NAN).is_err());
    }
}
