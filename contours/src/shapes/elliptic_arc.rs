//! The arc of an ellipse.

use std::f64::consts::FRAC_PI_2;

use super::ellipse;
use super::span::Span;
use crate::contour::{Seal, Trust};
use crate::nearest::gap;
use crate::proof::limits;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Point, Range, Vector, check};

/// Smallest distance of a cut from an end of the range, relative to the angles: nearer ones are the end itself, rounded.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// An arc of an ellipse, from one eccentric angle to another.
///
/// The point at the eccentric angle e is `center + R(rotation) (radii[0] cos e, radii[1] sin e)`. Angles that increase run
/// counterclockwise: the solid is inside, convex. Angles that decrease run clockwise: the solid is outside, concave.
///
/// The parameter is the eccentric angle travelled, from 0. The closest point comes from an iteration that cannot fail (a
/// convex function, approached from one side) and is exact to rounding for ratios of the radii from 1e-6 to 1e6, as are
/// the gap and the bounds, relative to the coordinates. On the major axis between the centres of curvature of its ends two
/// points are equally near; of a whole ellipse that is not rotated the one above (or to the right) is given.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): `center_x`, `center_y`, `first_radius`, `second_radius`, `rotation`.
///
/// ```
/// use std::f64::consts::TAU;
/// use rod_contours::{Contour, EllipticArc};
///
/// let ellipse = EllipticArc::new([0.0, 0.0], [2.0, 1.0], 0.0, 0.0, TAU)?;
/// assert!((ellipse.gap(0.0, -3.0) - 2.0).abs() < 1e-15);
/// assert!((ellipse.gap(0.0, 0.0) + 1.0).abs() < 1e-15);
///
/// // Only the lower half: from above, the other minimum of the distance.
/// let half = EllipticArc::new([0.0, 0.0], [2.0, 1.0], 0.0, -0.5 * TAU, 0.0)?;
/// let closest = half.closest(0.0, 0.5);
/// assert!((closest.gap + 1.5).abs() < 1e-15 && closest.interior);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticArc {
    center: Point,
    radii: [f64; 2],
    rotation: f64,
    /// Cosine and sine of the rotation.
    axis: Vector,
    span: Span,
}

impl EllipticArc {
    /// The arc about `center` (lengths) with these radii (lengths) along its own axes, which are rotated
    /// counterclockwise by `rotation` (rad), from one eccentric angle to another, rad.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a number that is not finite, [`ContourError::NotPositive`] for a radius that is not
    /// positive, [`ContourError::ArcAngle`] for angles that are the same or more than a full turn apart.
    pub fn new(
        center: Point,
        radii: [f64; 2],
        rotation: f64,
        from_angle: f64,
        to_angle: f64,
    ) -> Result<Self, ContourError> {
        let [first, second] = ["the ellipse's first radius", "the ellipse's second radius"];
        check::finite([
            ("x of the ellipse's centre", center[0]),
            ("y of the ellipse's centre", center[1]),
            (first, radii[0]),
            (second, radii[1]),
            ("the ellipse's rotation", rotation),
            ("the elliptic arc's first angle", from_angle),
            ("the elliptic arc's last angle", to_angle),
        ])?;
        check::positive(first, radii[0])?;
        check::positive(second, radii[1])?;
        let (sin, cos) = rotation.sin_cos();
        let span = Span::new("the elliptic arc", from_angle, to_angle)?;
        Ok(Self { center, radii, rotation, axis: [cos, sin], span })
    }

    /// The point in coordinates along the axes, from the centre.
    fn inward(&self, x: f64, y: f64) -> Vector {
        let [cos, sin] = self.axis;
        let (dx, dy) = (x - self.center[0], y - self.center[1]);
        [dx * cos + dy * sin, dy * cos - dx * sin]
    }

    /// The frame at `t`, and cosine and sine of the eccentric angle.
    fn frame_and_angle(&self, t: f64) -> (Frame, [f64; 2]) {
        let [a, b] = self.radii;
        let angle = self.span.at(t, 1.0);
        let (sin, cos) = angle.sin_cos();
        let sign = self.span.sign();
        let (along, across) = (a * cos, b * sin);
        let speed = (a * sin).hypot(b * cos);
        // The tangent is never more than a right angle away from that of the circle at the same eccentric angle.
        let leans = ((a - b) * sin * cos).atan2(a * sin * sin + b * cos * cos);
        let frame = Frame {
            x: self.center[0] + along * self.axis[0] - across * self.axis[1],
            y: self.center[1] + along * self.axis[1] + across * self.axis[0],
            alpha: self.rotation + angle + sign * FRAC_PI_2 + leans,
            speed,
            turning: sign * (a / speed) * (b / speed),
        };
        (frame, [cos, sin])
    }

    /// The closest point at `t` to a point given along the axes.
    fn closest_at(&self, t: f64, interior: bool, [px, py]: Point) -> Closest {
        let [a, b] = self.radii;
        let (frame, [cos, sin]) = self.frame_and_angle(t);
        let (dx, dy) = (px - a * cos, py - b * sin);
        // On the outward normal, without alpha and the rotation: shorter and more exact.
        let outside = self.span.sign() * (dx * (b * cos / frame.speed) + dy * (a * sin / frame.speed));
        Closest { t, gap: gap(interior, outside, [dx, dy]), frame, interior }
    }

    /// Where the feet of a point along the axes are passed, by the angle travelled in `range`: the nearest point of the
    /// whole ellipse, or the other minimum of the distance.
    fn foot(&self, [px, py]: Point, range: Range, other: bool) -> Option<f64> {
        let [a, b] = self.radii;
        let (major, ratio) = if a >= b { (a, b / a) } else { (b, a / b) };
        let (mut x, mut y) = (px.abs() / major, py.abs() / major);
        if a < b {
            (x, y) = (y, x);
        }
        let [mut cos, mut sin] = if other { ellipse::opposite(ratio, x, y)? } else { ellipse::nearest(ratio, x, y) };
        if a < b {
            (cos, sin) = (sin, cos);
        }
        let signed = |value: f64, along: f64| if along < 0.0 { -value } else { value };
        Some(self.span.travelled(signed(sin, py).atan2(signed(cos, px)), range))
    }
}

impl Contour for EllipticArc {
    fn frame(&self, t: f64) -> Frame {
        self.frame_and_angle(t).0
    }

    fn range(&self) -> Range {
        Range { from: 0.0, to: self.span.length() }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let range = self.range().within(range);
        let point = self.inward(x, y);
        let inside = |t: &f64| range.is_interior(*t);
        if let Some(t) = self.foot(point, range, false).filter(inside) {
            return self.closest_at(t, true, point);
        }
        let mut best = self.closest_at(range.from, false, point);
        let last = self.closest_at(range.to, false, point);
        if last.gap.abs() < best.gap.abs() {
            best = last;
        }
        if let Some(t) = self.foot(point, range, true).filter(inside) {
            let other = self.closest_at(t, true, point);
            if other.gap.abs() < best.gap.abs() {
                best = other;
            }
        }
        best
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let range = self.range().within(range);
        let mut bounds = Bounds::EMPTY;
        for frame in [self.frame(range.from), self.frame(range.to)] {
            bounds = bounds.with(frame.x, frame.y);
        }
        let ([a, b], [cos, sin]) = (self.radii, self.axis);
        // Each coordinate is `along cos e + across sin e`, largest at the angle of (along, across).
        for (coordinate, [along, across]) in [[a * cos, -b * sin], [a * sin, b * cos]].into_iter().enumerate() {
            let reach = along.hypot(across);
            let largest = across.atan2(along);
            if self.span.passes(largest, range) {
                bounds.max[coordinate] = bounds.max[coordinate].max(self.center[coordinate] + reach);
            }
            if self.span.passes(largest + 2.0 * FRAC_PI_2, range) {
                bounds.min[coordinate] = bounds.min[coordinate].min(self.center[coordinate] - reach);
            }
        }
        bounds
    }

    /// The ends of the axes: a quarter of an ellipse turns by a right angle.
    fn cuts(&self, range: Range) -> Vec<f64> {
        let range = self.range().within(range);
        let Span { from, to } = self.span;
        let margin = ROUNDING * from.abs().max(to.abs());
        let first = (from.min(to) / FRAC_PI_2).ceil();
        // A full turn passes four quarters, five if it starts on one.
        let mut cuts: Vec<f64> = (0..5)
            .map(|quarter| self.span.sign() * ((first + f64::from(quarter)) * FRAC_PI_2 - from))
            .filter(|&t| range.from + margin < t && t < range.to - margin)
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// An arc of an ellipse always.
    fn is_convex(&self, _: Range) -> bool {
        true
    }

    /// Least and greatest at the ends of the axes, and monotonic between them.
    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let range = self.range().within(range);
        let [a, b] = self.radii;
        let ends = [range.from, range.to].map(|t| self.frame(t).curvature());
        let sign = self.span.sign();
        let axes = (0..4).filter(|&quarter| self.span.passes(f64::from(quarter) * FRAC_PI_2, range));
        let axes = axes.map(|quarter| sign * if quarter % 2 == 0 { a / b / b } else { b / a / a });
        // Near the sharp end of a thin ellipse the rounding of the angle counts by as much as the ellipse is thin.
        let angle = self.span.from.abs().max(self.span.to.abs());
        let relative = ROUNDING * (1.0 + angle) * (a / b).max(b / a);
        limits::curvature_bounds(ends.into_iter().chain(axes), relative)
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        let (frame, [cos, sin]) = self.frame_and_angle(t);
        let [a, b] = self.radii;
        // the tangent is along (-a sin, b cos), either way
        let turn = sin * cos / (frame.speed * frame.speed);
        match parameter {
            "center_x" => Some(FrameRate::ALONG_X),
            "center_y" => Some(FrameRate::ALONG_Y),
            "first_radius" => Some(FrameRate { x: cos * self.axis[0], y: cos * self.axis[1], alpha: b * turn }),
            "second_radius" => Some(FrameRate { x: -sin * self.axis[1], y: sin * self.axis[0], alpha: -a * turn }),
            "rotation" => Some(FrameRate::rotation([frame.x - self.center[0], frame.y - self.center[1]])),
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
    fn a_rotated_ellipse_is_boxed_exactly() {
        let radii: [f64; 2] = [2.0, 1.0];
        for (from, to) in [(0.3, 0.3 + TAU), (-2.0, -2.0 - TAU)] {
            let ellipse = EllipticArc::new([1.0, -1.0], radii, 0.7, from, to).unwrap();
            let (sin, cos) = 0.7_f64.sin_cos();
            let (wide, high) = ((radii[0] * cos).hypot(radii[1] * sin), (radii[0] * sin).hypot(radii[1] * cos));
            assert_eq!(ellipse.bounds(), Bounds { min: [1.0 - wide, -1.0 - high], max: [1.0 + wide, -1.0 + high] });
        }
    }

    #[test]
    fn quarters_are_cut_at_the_ends_of_the_axes() {
        let whole = |from: f64, to: f64| EllipticArc::new([0.0, 0.0], [3.0, 0.1], 0.2, from, to).unwrap();
        let cuts = |shape: &EllipticArc| shape.cuts(shape.range());
        assert_eq!(cuts(&whole(0.0, TAU)), [FRAC_PI_2, PI, 1.5 * PI]);
        assert_eq!(cuts(&whole(0.0, -TAU)), [FRAC_PI_2, PI, 1.5 * PI]);
        assert_eq!(cuts(&whole(-0.5, 0.5)), [0.5]);
        assert_eq!(cuts(&whole(0.5, 0.5 + TAU)).len(), 4);
        assert!(cuts(&whole(FRAC_PI_2, PI)).is_empty());
        for shape in [whole(0.1, 6.3), whole(7.0, 2.0)] {
            let ends: Vec<f64> = [0.0].into_iter().chain(cuts(&shape)).chain([shape.range().to]).collect();
            for pair in ends.windows(2) {
                let turn = shape.frame(pair[1]).alpha - shape.frame(pair[0]).alpha;
                assert!(turn.abs() <= FRAC_PI_2 * (1.0 + 1e-14), "{turn}");
            }
        }
    }

    #[test]
    fn a_circle_is_an_ellipse() {
        let ellipse = EllipticArc::new([1.0, 2.0], [0.5, 0.5], 1.0, 0.3, -2.0).unwrap();
        let circle = crate::CircularArc::new([1.0, 2.0], 0.5, 1.3, -1.0).unwrap();
        for k in 0..100 {
            let (x, y) = (f64::from(k) * 0.03, 2.0 + f64::from(k).sin());
            let (one, two) = (ellipse.closest(x, y), circle.closest(x, y));
            assert!((one.gap - two.gap).abs() < 1e-14 && (one.t - 2.0 * two.t).abs() < 1e-14, "{one:?} {two:?}");
        }
        assert!((ellipse.gap(1.0, 2.0).abs() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn arcs_that_cannot_be() {
        let message = |radii, to| EllipticArc::new([0.0, 0.0], radii, 0.0, 0.0, to).unwrap_err().to_string();
        assert_eq!(message([1.0, 0.0], 1.0), "the ellipse's second radius is 0, expected a positive number");
        assert_eq!(message([f64::NAN, 1.0], 1.0), "the ellipse's first radius is NaN, expected a finite number");
        assert!(message([1.0, 1.0], 6.5).starts_with("the elliptic arc runs from angle 0 to 6.5, expected"));
    }
}
