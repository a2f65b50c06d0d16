//! A shape travelled the other way.

use std::f64::consts::PI;

use crate::contour::{Seal, Trust};
use crate::nearest::cuts;
use crate::{Bounds, Closest, Contour, Frame, FrameRate, Range};

/// The same curve travelled the other way, by `-t`: solid and outside are exchanged.
///
/// ```
/// use rod_contours::{Contour, Parabola, Reversed};
///
/// // The solid below the parabola.
/// let hill = Reversed::new(Parabola::new([0.0, 0.0], -5.0)?);
/// assert_eq!(hill.gap(0.0, 0.1), 0.1);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reversed<C> {
    shape: C,
}

impl<C: Contour> Reversed<C> {
    /// The shape travelled the other way.
    pub fn new(shape: C) -> Self {
        Self { shape }
    }

    /// The closest point seen from the other side.
    fn reverse_closest(closest: Closest, x: f64, y: f64) -> Closest {
        // What is straight ahead of an end is outside either way.
        let ahead = !closest.interior && closest.frame.local(x, y).1 == 0.0;
        let gap = if ahead { closest.gap.abs() } else { -closest.gap };
        Closest { t: -closest.t, gap, frame: reversed_frame(closest.frame), interior: closest.interior }
    }
}

fn reversed_frame(frame: Frame) -> Frame {
    Frame { alpha: frame.alpha + PI, turning: -frame.turning, ..frame }
}

impl<C: Contour> Contour for Reversed<C> {
    fn frame(&self, t: f64) -> Frame {
        reversed_frame(self.shape.frame(-t))
    }

    fn range(&self) -> Range {
        self.shape.range().backwards()
    }

    fn closest(&self, x: f64, y: f64) -> Closest {
        Self::reverse_closest(self.shape.closest(x, y), x, y)
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        Self::reverse_closest(self.shape.closest_in(range.backwards(), x, y), x, y)
    }

    fn bounds(&self) -> Bounds {
        self.shape.bounds()
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        self.shape.bounds_in(range.backwards())
    }

    fn cuts(&self, range: Range) -> Vec<f64> {
        cuts::reverse(self.shape.cuts(range.backwards()))
    }

    fn is_convex(&self, range: Range) -> bool {
        self.shape.is_convex(range.backwards())
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let (least, largest) = self.shape.curvature_in(range.backwards());
        (-largest, -least)
    }

    fn closest_is_exact(&self) -> bool {
        self.shape.closest_is_exact()
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        self.shape.frame_rate(-t, parameter)
    }

    fn trust(&self, seal: Seal) -> Trust {
        self.shape.trust(seal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EllipticArc, Line};

    #[test]
    fn a_line_backwards_is_the_line_from_end_to_end() {
        let line = Line::new([0.0, 0.0], [2.0, 0.0]).unwrap();
        let back = Reversed::new(line);
        let same = Line::new([2.0, 0.0], [0.0, 0.0]).unwrap();
        for [x, y] in [[0.5, 1.0], [0.5, -1.0], [-1.0, 0.0], [3.0, 0.5]] {
            assert_eq!(back.gap(x, y), same.gap(x, y));
            assert_eq!(back.closest(x, y).frame, same.closest(x, y).frame);
        }
        assert_eq!(back.range(), Range { from: -2.0, to: -0.0 });
        assert_eq!(back.bounds(), line.bounds());
        // Straight ahead is outside for both.
        assert!(line.gap(3.0, 0.0) > 0.0 && back.gap(3.0, 0.0) > 0.0);
    }

    #[test]
    fn cuts_are_in_order() {
        let shape = EllipticArc::new([0.0, 0.0], [2.0, 1.0], 0.3, 0.5, 5.0).unwrap();
        let cuts = Reversed::new(shape).cuts(Range { from: -4.5, to: -0.0 });
        assert_eq!(cuts.len(), 3);
        assert!(cuts.is_sorted());
    }
}
