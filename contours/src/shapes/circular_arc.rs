//! The arc of a circle.

use std::f64::consts::FRAC_PI_2;

use super::span::Span;
use crate::contour::{Seal, Trust};
use crate::nearest::cuts;
use crate::proof::limits;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Point, Range, check};

/// Rounding of the curvature, relative.
const CURVATURE_ROUNDING: f64 = 2.0 * f64::EPSILON;

/// An arc of a circle, from one polar angle (seen from the centre) to another.
///
/// Angles that increase run counterclockwise: the solid is inside, convex. Angles that decrease run clockwise: the solid
/// is outside, the arc is the border of a hole, concave.
///
/// The parameter is the arc length, from 0. The gap's absolute error is that of the coordinates relative to the centre and
/// of the radius. All points are equally near to the centre itself; it gets the middle of the arc.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): `center_x`, `center_y`, `radius`.
///
/// ```
/// use std::f64::consts::PI;
/// use rod_contours::{CircularArc, Contour};
///
/// // The lower half of a disc, and of a hole.
/// let disc = CircularArc::new([0.0, 1.0], 0.5, -PI, 0.0)?;
/// let hole = CircularArc::new([0.0, 1.0], 0.5, 0.0, -PI)?;
/// assert_eq!(disc.gap(0.0, 0.25), 0.25);
/// assert_eq!(hole.gap(0.0, 0.25), -0.25);
///
/// // Above the centre the ends are nearest.
/// let closest = disc.closest(0.875, 1.5);
/// assert!((closest.gap - 0.625).abs() < 1e-15 && !closest.interior);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircularArc {
    center: Point,
    radius: f64,
    span: Span,
}

impl CircularArc {
    /// The arc about `center` (lengths) with this radius (a length) from one polar angle to another, rad.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a number that is not finite, [`ContourError::NotPositive`] for a radius that is not
    /// positive, [`ContourError::ArcAngle`] for angles that are the same or more than a full turn apart.
    pub fn new(center: Point, radius: f64, from_angle: f64, to_angle: f64) -> Result<Self, ContourError> {
        check::finite([
            ("x of the arc's centre", center[0]),
            ("y of the arc's centre", center[1]),
            ("the arc's radius", radius),
            ("the arc's first angle", from_angle),
            ("the arc's last angle", to_angle),
        ])?;
        check::positive("the arc's radius", radius)?;
        Ok(Self { center, radius, span: Span::new("the arc", from_angle, to_angle)? })
    }

    /// A range of arc length as the angle travelled.
    fn angles(&self, range: Range) -> Range {
        Range { from: range.from / self.radius, to: range.to / self.radius }
    }
}

impl Contour for CircularArc {
    fn frame(&self, t: f64) -> Frame {
        let angle = self.span.at(t, self.radius);
        let (sin, cos) = angle.sin_cos();
        let sign = self.span.sign();
        Frame {
            x: self.center[0] + self.radius * cos,
            y: self.center[1] + self.radius * sin,
            alpha: angle + sign * FRAC_PI_2,
            speed: 1.0,
            turning: sign / self.radius,
        }
    }

    fn range(&self) -> Range {
        Range { from: 0.0, to: self.radius * self.span.length() }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let range = self.range().within(range);
        let (dx, dy) = (x - self.center[0], y - self.center[1]);
        let t = if dx == 0.0 && dy == 0.0 {
            0.5 * (range.from + range.to)
        } else {
            self.radius * self.span.travelled(dy.atan2(dx), self.angles(range))
        };
        if range.is_interior(t) {
            let gap = self.span.sign() * (dx.hypot(dy) - self.radius);
            return Closest { t, gap, frame: self.frame(t), interior: true };
        }
        // At most half a turn from the middle of the range, so the end on this side is the nearer one.
        let t = range.clamp(t);
        Closest::new(t, self.frame(t), false, x, y)
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let range = self.range().within(range);
        let mut bounds = Bounds::EMPTY;
        for frame in [self.frame(range.from), self.frame(range.to)] {
            bounds = bounds.with(frame.x, frame.y);
        }
        let [x, y] = self.center;
        for (quarter, [along_x, along_y]) in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].into_iter().enumerate()
        {
            if self.span.passes(quarter as f64 * FRAC_PI_2, self.angles(range)) {
                bounds = bounds.with(x + self.radius * along_x, y + self.radius * along_y);
            }
        }
        bounds
    }

    /// Arcs of equal length.
    fn cuts(&self, range: Range) -> Vec<f64> {
        let range = self.range().within(range);
        let count = cuts::arc_count(range.length() / self.radius);
        (1..count).map(|arc| range.at(arc as f64 / count as f64)).collect()
    }

    /// An arc of a circle always.
    fn is_convex(&self, _: Range) -> bool {
        true
    }

    fn curvature_in(&self, _: Range) -> (f64, f64) {
        limits::curvature_bounds([self.span.sign() / self.radius], CURVATURE_ROUNDING)
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        match parameter {
            "center_x" => Some(FrameRate::ALONG_X),
            "center_y" => Some(FrameRate::ALONG_Y),
            "radius" => {
                // the same way along a larger circle is a smaller angle
                let turn = -self.span.sign() * t / (self.radius * self.radius);
                let (sin, cos) = self.span.at(t, self.radius).sin_cos();
                let along = self.radius * turn;
                Some(FrameRate { x: cos - along * sin, y: sin + along * cos, alpha: turn })
            }
            _ => None,
        }
    }

    fn trust(&self, _: Seal) -> Trust {
        Trust::SIMPLE
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    #[test]
    fn a_full_circle_is_boxed_by_its_radius_and_cut_in_four() {
        for (from, to) in [(0.3, 0.3 + TAU), (2.0, 2.0 - TAU)] {
            let circle = CircularArc::new([1.0, 2.0], 0.5, from, to).unwrap();
            assert_eq!(circle.bounds(), Bounds { min: [0.5, 1.5], max: [1.5, 2.5] });
            assert_eq!(circle.cuts(circle.range()).len(), 3);
            assert_eq!(circle.gap(1.0, 2.0).abs(), 0.5);
            assert!(circle.closest(1.0, 2.0).interior);
        }
        let quarter = CircularArc::new([0.0, 0.0], 1.0, 0.0, FRAC_PI_2).unwrap();
        assert!(quarter.cuts(quarter.range()).is_empty());
    }

    #[test]
    fn angles_wrap() {
        // The part about the angle pi of an arc given by angles around 5 pi.
        let arc = CircularArc::new([0.0, 0.0], 2.0, 4.5 * PI, 5.5 * PI).unwrap();
        for y in [1e-300, -1e-300, 0.0, 0.1, -0.1] {
            let closest = arc.closest(-3.0, y);
            assert!(closest.interior && (closest.t - PI * 2.0 * 0.5).abs() < 0.1, "{closest:?}");
        }
        let part = Range { from: 0.0, to: 1.0 };
        assert_eq!(arc.closest_in(part, -3.0, 0.1).t, 1.0);
        assert_eq!(arc.closest_in(part, 3.0, 0.1).t, 0.0);
    }

    #[test]
    fn arcs_that_cannot_be() {
        let message = |radius, from, to| CircularArc::new([0.0, 0.0], radius, from, to).unwrap_err().to_string();
        assert_eq!(message(-1.0, 0.0, 1.0), "the arc's radius is -1, expected a positive number");
        assert_eq!(message(f64::INFINITY, 0.0, 1.0), "the arc's radius is inf, expected a finite number");
        assert_eq!(message(1.0, 0.0, f64::NAN), "the arc's last angle is NaN, expected a finite number");
        assert_eq!(
            message(1.0, 0.0, 7.0),
            "the arc runs from angle 0 to 7, expected two different angles at most a full turn (2 pi) apart"
        );
        assert!(message(1.0, 2.0, 2.0).starts_with("the arc runs from angle 2 to 2"));
    }
}
