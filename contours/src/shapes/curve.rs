//! The curve of a function of one parameter.

use std::fmt;
use std::sync::Arc;

use super::function::{self, Function, Jet, variable};
use crate::nearest::search::CELLS;
use crate::point::{cross, dot, nearest_turn};
use crate::proof::limits::LimitsOf;
use crate::{Bounds, Closest, Contour, ContourError, Frame, Limits, Range, Vector, check};

/// Halvings of a cell in which the direction turns fast, before it counts as a jump.
const HALVINGS: u32 = 30;

/// Smallest speed accepted, relative to the largest: below it the curve turns round within too short a length for anything
/// that bends.
const STANDSTILL: f64 = 1e-9;

/// r, r' and r'' at t.
type Derivatives = dyn Fn(f64) -> [Vector; 3] + Send + Sync;

/// The curve `r(t) = (x(t), y(t))` over a finite range; the solid is on the left of the way to larger t.
///
/// Point and rates are as exact as the function. Alpha is the angle of `r'`; which turn it is in was found when the curve
/// was made, by following the direction from 97 samples through as many halvings as it takes until neighbours differ by
/// less than a right angle. A whole turn within a 96th of the range can go unseen: cut such a curve into pieces. Closest
/// points come from the trait's default search, of which see the limits at [`Contour::closest_in`].
///
/// ```
/// use std::f64::consts::TAU;
/// use rod_contours::{Contour, Curve, DualNum, Range};
///
/// // Two turns of a spiral.
/// let spiral = Curve::new(Range { from: 0.0, to: 2.0 * TAU }, |t| [(t + 1.0) * t.cos(), (t + 1.0) * t.sin()])?;
/// let turn = spiral.frame(2.0 * TAU).alpha - spiral.frame(0.0).alpha;
/// assert!((turn - 2.0 * TAU).abs() < 1.0);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone)]
pub struct Curve {
    range: Range,
    derivatives: Arc<Derivatives>,
    /// Parameters in order, and alpha there.
    angles: Arc<[[f64; 2]]>,
    limits: Option<LimitsOf>,
}

impl Curve {
    /// The curve of `r` over a range of its parameter. The derivatives are computed along with r, exactly.
    ///
    /// # Errors
    ///
    /// [`ContourError::EmptyRange`] unless the range's start is less than its end (NaN included),
    /// [`ContourError::NotFinite`] for a range that is infinite. At the samples described above:
    /// [`ContourError::NotFiniteAt`] for a coordinate or a derivative that is not finite, [`ContourError::Standstill`]
    /// for a speed that is 0 or less than 1e-9 of the largest, [`ContourError::Jump`] for a direction that jumps.
    pub fn new(range: Range, r: impl Fn(Jet) -> [Jet; 2] + Send + Sync + 'static) -> Result<Self, ContourError> {
        Self::with_derivatives(range, move |t| {
            let [x, y] = r(variable(t));
            [[x.re, y.re], [x.v1, y.v1], [x.v2, y.v2]]
        })
    }

    /// The curve of a function that gives the point and its first two derivatives `[r, r', r'']`.
    ///
    /// # Errors
    ///
    /// As for [`new`](Self::new).
    pub fn with_derivatives(
        range: Range,
        derivatives: impl Fn(f64) -> [Vector; 3] + Send + Sync + 'static,
    ) -> Result<Self, ContourError> {
        check::range("the curve's parameter", range)?;
        let Range { from, to } = range;
        check::finite([("the start of the curve's parameter", from), ("the end of the curve's parameter", to)])?;
        let mut follow = Follow { derivatives: &derivatives, largest: 0.0, found: Vec::new() };
        let mut left = follow.start(from)?;
        for cell in 1..=CELLS {
            let right = follow.stop(range.at(cell as f64 / CELLS as f64))?;
            follow.turn(left, right, HALVINGS)?;
            left = right;
        }
        let Follow { largest, found, .. } = follow;
        if let Some(slow) = found.iter().find(|stop| stop.speed <= STANDSTILL * largest) {
            return Err(ContourError::Standstill { what: "the curve", t: slow.t });
        }
        let angles = found.iter().map(|stop| [stop.t, stop.alpha]).collect();
        Ok(Self { range, derivatives: Arc::new(derivatives), angles, limits: None })
    }

    /// The same with limits of its speed and curvature over any part of its range, by which its closest points, box,
    /// inflections and convex parts are proven in place of sampled ([`Contour::closest_is_exact`]). A closest point takes a few tens
    /// of parts with sharp limits; what limits leave undecided after 2e5 parts stays at the nearest point found.
    ///
    /// ```
    /// use rod_contours::{Contour, Curve, DualNum, Limits, Range};
    ///
    /// // A circle of radius 2 by the angle.
    /// let circle = Curve::new(Range { from: 0.0, to: 6.0 }, |t| [t.cos() * 2.0, t.sin() * 2.0])?;
    /// let circle = circle.with_limits(|_| Limits { speed: 2.0, curvature: (0.5, 0.5) })?;
    /// assert!(circle.closest_is_exact() && (circle.gap(0.0, 0.0) + 2.0).abs() < 1e-15);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a range that is infinite; [`ContourError::BeyondLimit`] where one of 768 samples lies
    /// outside the limits of a part around it. Values between the samples are not tested.
    pub fn with_limits(self, limits: impl Fn(Range) -> Limits + Send + Sync + 'static) -> Result<Self, ContourError> {
        let known = function::check_limits(&self, limits)?;
        Ok(Self { limits: Some(known), ..self })
    }

    /// Alpha at `t` where the direction is `angle`, but for whole turns.
    fn unwrap_angle(&self, t: f64, angle: f64) -> f64 {
        // Between two entries the angle is within a right angle of either; the nearer one decides at the ends too.
        let after = self.angles.partition_point(|entry| entry[0] < t).clamp(1, self.angles.len() - 1);
        let ([t_before, before], [t_after, after]) = (self.angles[after - 1], self.angles[after]);
        let share = ((t - t_before) / (t_after - t_before)).clamp(0.0, 1.0);
        let near = before + share * (after - before);
        nearest_turn(angle, near)
    }
}

impl Function for Curve {
    fn limits(&self) -> Option<&LimitsOf> {
        self.limits.as_ref()
    }

    fn derivatives_at(&self, t: f64) -> [Vector; 3] {
        (self.derivatives)(t)
    }
}

impl fmt::Debug for Curve {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Curve").field("range", &self.range).finish_non_exhaustive()
    }
}

impl Contour for Curve {
    fn frame(&self, t: f64) -> Frame {
        let [[x, y], velocity, acceleration] = (self.derivatives)(t);
        let speed = velocity[0].hypot(velocity[1]);
        Frame {
            x,
            y,
            alpha: self.unwrap_angle(t, velocity[1].atan2(velocity[0])),
            speed,
            turning: cross(velocity, acceleration) / speed / speed,
        }
    }

    fn range(&self) -> Range {
        self.range
    }

    function::methods_of_function!();
}

/// A place on the curve where the direction is known.
#[derive(Clone, Copy)]
struct Stop {
    t: f64,
    direction: Vector,
    speed: f64,
    /// In the right turn only for those found.
    alpha: f64,
}

/// Follows the direction along the curve.
struct Follow<'a, F> {
    derivatives: &'a F,
    /// The largest speed so far.
    largest: f64,
    found: Vec<Stop>,
}

impl<F: Fn(f64) -> [Vector; 3]> Follow<'_, F> {
    fn start(&mut self, t: f64) -> Result<Stop, ContourError> {
        let stop = self.stop(t)?;
        self.found.push(stop);
        Ok(stop)
    }

    fn stop(&mut self, t: f64) -> Result<Stop, ContourError> {
        let [point, velocity, acceleration] = (self.derivatives)(t);
        for (what, pair) in [
            (["x", "y"], point),
            (["dx/dt", "dy/dt"], velocity),
            (["the second derivative of x", "the second derivative of y"], acceleration),
        ] {
            check::finite_at(t, what.into_iter().zip(pair))?;
        }
        let speed = velocity[0].hypot(velocity[1]);
        if speed == 0.0 {
            return Err(ContourError::Standstill { what: "the curve", t });
        }
        self.largest = self.largest.max(speed);
        let direction = velocity.map(|component| component / speed);
        Ok(Stop { t, direction, speed, alpha: direction[1].atan2(direction[0]) })
    }

    /// Goes on from the last stop found, which is `left`, to `right`.
    fn turn(&mut self, left: Stop, right: Stop, halvings: u32) -> Result<(), ContourError> {
        let middle = self.stop(0.5 * (left.t + right.t))?;
        let near = |one: Stop, other: Stop| dot(one.direction, other.direction) > 0.0;
        if near(left, middle) && near(middle, right) && near(left, right) {
            self.add(left, middle);
            self.add(middle, right);
            return Ok(());
        }
        if halvings == 0 {
            let slow = middle.speed <= STANDSTILL.sqrt() * self.largest;
            let (what, t) = ("the curve", middle.t);
            return Err(if slow { ContourError::Standstill { what, t } } else { ContourError::Jump { what, t } });
        }
        self.turn(left, middle, halvings - 1)?;
        self.turn(middle, right, halvings - 1)
    }

    /// Adds a stop that differs from the one before by less than a right angle.
    fn add(&mut self, before: Stop, stop: Stop) {
        let turned = cross(before.direction, stop.direction).atan2(dot(before.direction, stop.direction));
        let alpha = self.found.last().map_or(stop.alpha, |last| last.alpha + turned);
        self.found.push(Stop { alpha, ..stop });
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::{DualNum, EllipticArc};

    #[test]
    fn a_curve_of_an_ellipse_is_an_ellipse() {
        let (from, to) = (0.4, 0.4 + TAU);
        let arc = EllipticArc::new([0.0, 0.0], [3.0, 0.2], 0.0, from, to).unwrap();
        let curve = Curve::new(Range { from, to }, |e| [e.cos() * 3.0, e.sin() * 0.2]).unwrap();
        for k in 0..=300 {
            let t = TAU * f64::from(k) / 300.0;
            let (one, two) = (curve.frame(from + t), arc.frame(t));
            assert!((one.x - two.x).hypot(one.y - two.y) < 1e-14);
            assert!((one.alpha - two.alpha).abs() < 1e-13, "{one:?} {two:?}");
            assert!((one.speed - two.speed).abs() < 1e-14 && (one.turning - two.turning).abs() < 1e-12);
        }
        for k in 0..100 {
            let (x, y) = ((f64::from(k) * 0.7).sin() * 4.0, (f64::from(k) * 1.7).cos());
            assert!((curve.gap(x, y).abs() - arc.gap(x, y).abs()).abs() < 1e-13);
        }
    }

    #[test]
    fn fast_turns_are_followed() {
        // A full turn of the direction within a thousandth of the range, by a steep arc tangent.
        let curve = Curve::with_derivatives(Range { from: -1.0, to: 1.0 }, |t| {
            let angle = 2.0 * (1e4 * t).atan();
            let rate = 2e4 / (1.0 + 1e8 * t * t);
            [[0.0, 0.0], [angle.cos(), angle.sin()], [-rate * angle.sin(), rate * angle.cos()]]
        });
        let curve = curve.unwrap();
        for k in -100_i32..=100 {
            let t = 1e-5 * f64::from(k) * f64::from(k.abs());
            let turned = curve.frame(t).alpha - curve.frame(-1.0).alpha;
            assert!((turned - 2.0 * ((1e4 * t).atan() + 1e4_f64.atan())).abs() < 1e-13, "{t} {turned}");
        }
    }

    #[test]
    fn curves_that_cannot_be() {
        let unit = Range { from: -1.0, to: 1.0 };
        let message = |curve: Result<Curve, ContourError>| curve.unwrap_err().to_string();
        let cusp = message(Curve::new(unit, |t| [t.powi(2), t.powi(3)]));
        assert!(cusp.starts_with("the curve stands still at t = 0, expected"), "{cusp}");
        let off = message(Curve::new(Range { from: -1.0, to: 2.3 }, |t| [t.powi(2), t.powi(3)]));
        assert!(off.starts_with("the curve stands still at t = "), "{off}");
        let kink = message(Curve::with_derivatives(unit, |t| [[t, t.abs()], [1.0, 2.0 * t.signum()], [0.0, 0.0]]));
        assert!(kink.starts_with("the direction of the curve jumps at t = "), "{kink}");
        let pole = message(Curve::new(unit, |t| [t, t.recip()]));
        assert!(pole.contains("y is ") && pole.contains("at t = 0, expected finite"), "{pole}");
        assert_eq!(
            message(Curve::new(Range::ALL, |t| [t, t])),
            "the start of the curve's parameter is -inf, expected a finite number"
        );
        assert!(message(Curve::new(Range { from: 1.0, to: 1.0 }, |t| [t, t])).contains("runs from 1 to 1"));
    }
}
