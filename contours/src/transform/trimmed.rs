//! A part of a shape.

use crate::contour::{Seal, Trust};
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Range, check};

/// The part of a shape in a range of its parameter, which it keeps.
///
/// ```
/// use rod_contours::{CircularArc, Contour, Range, Trimmed};
///
/// let circle = CircularArc::new([0.0, 0.0], 2.0, 0.0, 6.0)?;
/// let start = Trimmed::new(circle, Range { from: 0.0, to: 1.0 })?;
/// assert!(!start.closest(0.0, 3.0).interior);
/// assert!(Trimmed::new(circle, Range { from: 0.0, to: 12.5 }).is_err());
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trimmed<C> {
    shape: C,
    range: Range,
}

impl<C: Contour> Trimmed<C> {
    /// The part of the shape in `range`, its parameter.
    ///
    /// # Errors
    ///
    /// [`ContourError::EmptyRange`] unless the range's start is less than its end (NaN included),
    /// [`ContourError::NotWithin`] for a range that leaves that of the shape.
    pub fn new(shape: C, range: Range) -> Result<Self, ContourError> {
        check::range("the part of the shape", range)?;
        let Range { from, to } = range;
        let whole = shape.range();
        if !(whole.contains(from) && whole.contains(to)) {
            return Err(ContourError::NotWithin { from, to, start: whole.from, end: whole.to });
        }
        Ok(Self { shape, range })
    }
}

impl<C: Contour> Contour for Trimmed<C> {
    fn frame(&self, t: f64) -> Frame {
        self.shape.frame(t)
    }

    fn range(&self) -> Range {
        self.range
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        self.shape.closest_in(range, x, y)
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        self.shape.bounds_in(range)
    }

    fn cuts(&self, range: Range) -> Vec<f64> {
        self.shape.cuts(range)
    }

    fn is_convex(&self, range: Range) -> bool {
        self.shape.is_convex(range)
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        self.shape.curvature_in(range)
    }

    fn closest_is_exact(&self) -> bool {
        self.shape.closest_is_exact()
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        self.shape.frame_rate(t, parameter)
    }

    fn trust(&self, seal: Seal) -> Trust {
        self.shape.trust(seal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parabola;

    #[test]
    fn a_trimmed_parabola_is_its_part() {
        let whole = Parabola::new([0.3, 0.1], 2.0).unwrap();
        let part = whole.between(0.0, 1.0).unwrap();
        let trimmed = Trimmed::new(whole, part.range()).unwrap();
        for k in 0..50 {
            let (x, y) = (f64::from(k) * 0.1 - 2.0, (f64::from(k) * 0.7).sin());
            assert_eq!(trimmed.closest(x, y), part.closest(x, y));
        }
        assert_eq!(trimmed.bounds(), part.bounds());
    }

    #[test]
    fn parts_that_cannot_be() {
        let shape = Parabola::new([0.0, 0.0], 2.0).unwrap().between(0.0, 1.0).unwrap();
        let message = |from, to| Trimmed::new(shape, Range { from, to }).unwrap_err().to_string();
        assert_eq!(message(0.5, 2.0), "the part from 0.5 to 2 leaves the shape's range, 0 to 1; expected a part of it");
        assert_eq!(
            message(0.5, 0.5),
            "the part of the shape runs from 0.5 to 0.5, expected the start to be less than the end"
        );
        assert!(message(f64::NAN, 1.0).contains("NaN"));
    }
}
