//! The conditions at the ends of a spline.

use crate::point::{minus, plus};
use crate::{ContourError, Vector, check};

/// The conditions at the ends of a spline through points.
///
/// ```
/// use rod_contours::{Contour, Spline, SplineEnd};
///
/// // A quarter of the unit circle, with its tangents known and estimated.
/// let points: Vec<[f64; 2]> = (0..=8).map(|k| f64::from(k) * 0.19634954084936207).map(|a| [a.sin(), -a.cos()]).collect();
/// let right = std::f64::consts::FRAC_PI_2;
/// let known = Spline::through(&points, SplineEnd::Clamped { from: Some(0.0), to: Some(right) })?;
/// assert!(known.frame(0.0).alpha.abs() < 1e-15);
/// let estimated = Spline::through(&points, SplineEnd::Clamped { from: None, to: None })?;
/// assert!(estimated.frame(0.0).alpha.abs() < 2e-3);
/// let natural = Spline::through(&points, SplineEnd::Natural)?;
/// assert!(natural.frame(0.0).curvature().abs() < 1e-12);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SplineEnd {
    /// The curvature vanishes at both ends: a thin strip bent through the points, free beyond them.
    Natural,
    /// The direction is given at both ends, and the speed there is 1.
    Clamped {
        /// Tangent angle at the start, rad; by default that of the cubic through the first four points.
        from: Option<f64>,
        /// Tangent angle at the end, rad; by default that of the cubic through the last four points.
        to: Option<f64>,
    },
    /// A closed curve, as smooth where it closes as elsewhere. The first point may be given again as the last one (to
    /// 1e-9 of the way around); if it is not, the curve goes on from the last point to the first.
    Periodic,
}

impl SplineEnd {
    /// Checks that angles are finite.
    pub(super) fn check(&self) -> Result<(), ContourError> {
        let Self::Clamped { from, to } = *self else { return Ok(()) };
        let angles = [("the tangent angle at the spline's start", from), ("the tangent angle at the spline's end", to)];
        check::finite(angles.into_iter().filter_map(|(what, angle)| Some((what, angle?))))
    }
}

/// The unit vector at this angle, or without one the direction in which the polynomial through these knots and points (up
/// to four) passes the first of them.
pub(super) fn direction(angle: Option<f64>, near: Vec<(f64, Vector)>) -> Vector {
    if let Some(angle) = angle {
        let (sin, cos) = angle.sin_cos();
        return [cos, sin];
    }
    // Newton's form: the divided differences, each times how far the first knot is from the others below the highest.
    let mut differences = near.clone();
    let mut derivative = [0.0; 2];
    let mut factor = 1.0;
    for order in 1..near.len() {
        for k in 0..near.len() - order {
            let width = near[k + order].0 - near[k].0;
            let (here, next) = (differences[k].1, differences[k + 1].1);
            differences[k].1 = minus(next, here).map(|side| side / width);
        }
        derivative = plus(derivative, factor, differences[0].1);
        factor *= near[0].0 - near[order].0;
    }
    let length = derivative[0].hypot(derivative[1]);
    // A polynomial that stands still has no direction; then the spline stands still there too, and says so.
    if length > 0.0 { derivative.map(|side| side / length) } else { derivative }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_direction_of_a_cubic_is_found_from_four_points() {
        let curve = |t: f64| [t + t * t - t * t * t, 2.0 * t - 3.0 * t * t + 0.5 * t * t * t];
        let on = |knots: [f64; 4]| knots.map(|t| (t, curve(t))).to_vec();
        let [x, y] = direction(None, on([0.0, 0.3, 0.5, 0.9]));
        assert!((x - 1.0 / 5.0_f64.sqrt()).abs() < 1e-15 && (y - 2.0 / 5.0_f64.sqrt()).abs() < 1e-15);
        // The order of the knots does not change the direction of travel.
        let [x, y] = direction(None, on([0.9, 0.5, 0.3, 0.0]));
        let tangent = (2.0 - 5.4 + 1.5 * 0.81_f64).atan2(1.0 + 1.8 - 3.0 * 0.81);
        assert!((y.atan2(x) - tangent).abs() < 1e-14);
        assert_eq!(direction(None, vec![(0.0, [0.0, 0.0]), (0.3, [0.0, 0.3])]), [0.0, 1.0]);
    }
}
