//! The spline through given points.

use super::end::direction;
use super::keys::Keys;
use super::{Spline, SplineEnd};
use crate::point::{distance, is_closed, minus, plus};
use crate::{ContourError, Point, Vector, check};

impl Spline {
    /// The cubic spline through these points (lengths), in their order, with continuous direction and curvature.
    ///
    /// The parameter of a point is the length of the polygon up to it, so that the speed is about 1. Between points `h`
    /// apart the curve leaves a smooth one by `O(h^4)`; near natural ends by `O(h^2)`. The work is linear in the number of
    /// points.
    ///
    /// # Errors
    ///
    /// Fewer than two points, or three of a closed curve ([`ContourError::TooFewPoints`]); a point that is not finite
    /// ([`ContourError::PointNotFinite`]) or the same as the one before ([`ContourError::RepeatedPoint`]); a tangent angle
    /// that is not finite ([`ContourError::NotFinite`]); points between which the spline stands still, that is, turns back
    /// on itself ([`ContourError::Standstill`]).
    ///
    /// ```
    /// use rod_contours::{Contour, Spline, SplineEnd};
    ///
    /// let points = (0..32).map(|k| f64::from(k) * std::f64::consts::TAU / 32.0).map(|a| [a.cos(), a.sin()]);
    /// let disc = Spline::through(&points.collect::<Vec<_>>(), SplineEnd::Periodic)?;
    /// assert!((disc.gap(0.0, 3.0) - 2.0).abs() < 1e-5);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn through(points: &[Point], end: SplineEnd) -> Result<Self, ContourError> {
        end.check()?;
        let closed = end == SplineEnd::Periodic;
        let mut points = points.to_vec();
        if closed {
            close(&mut points);
            if points.len() < 4 {
                // Without the first one given again.
                let count = points.len().saturating_sub(1);
                return Err(ContourError::TooFewPoints { what: "a closed spline", count, needed: 3 });
            }
        }
        let knots = knots(&points)?;
        Self::from_keys(interpolant(&knots, &points, end))
    }
}

/// Makes the last point the first one: in its place where it is the same to rounding, else after it.
fn close(points: &mut Vec<Point>) {
    if is_closed(points) {
        points.pop();
    }
    points.extend(points.first().copied());
}

/// The length of the polygon up to each point.
pub(super) fn knots(points: &[Point]) -> Result<Vec<f64>, ContourError> {
    if points.len() < 2 {
        return Err(ContourError::TooFewPoints { what: "a spline", count: points.len(), needed: 2 });
    }
    check::points(points)?;
    let mut knots = vec![0.0];
    let mut t = 0.0;
    for (index, pair) in points.windows(2).enumerate() {
        let next = t + distance(pair[0], pair[1]);
        // Also where the distance is lost to rounding beside the length so far.
        if next <= t {
            let [x, y] = pair[1];
            return Err(ContourError::RepeatedPoint { point: index + 2, x, y });
        }
        knots.push(next);
        t = next;
    }
    Ok(knots)
}

/// The keys of the spline with continuous second derivative through the points at the knots.
pub(super) fn interpolant(knots: &[f64], points: &[Point], end: SplineEnd) -> Keys {
    let last = points.len() - 1;
    let width = |k: usize| knots[k + 1] - knots[k];
    let chord = |k: usize| minus(points[k + 1], points[k]).map(|side| side / width(k));
    // The second derivatives of the cubics before and after a point are equal.
    let row = |before: usize, after: usize| {
        let share = width(after) / (width(before) + width(after));
        let (left, right) = (chord(before), chord(after));
        let right_side = [0, 1].map(|side| 3.0 * (share * left[side] + (1.0 - share) * right[side]));
        Row { below: share, diagonal: 2.0, above: 1.0 - share, right: [right_side[0], right_side[1], 0.0] }
    };
    let free = |below: f64, above: f64, chord: Vector| {
        let right = [3.0 * chord[0], 3.0 * chord[1], 0.0];
        Row { below, diagonal: 2.0, above, right }
    };
    let fixed = |[x, y]: Point| Row { below: 0.0, diagonal: 1.0, above: 0.0, right: [x, y, 0.0] };
    let inner = (1..last).map(|k| row(k - 1, k));
    let velocities = match end {
        SplineEnd::Natural => {
            let ends = [free(0.0, 1.0, chord(0)), free(1.0, 0.0, chord(last - 1))];
            solve([ends[0]].into_iter().chain(inner).chain([ends[1]]).collect())
        }
        SplineEnd::Clamped { from, to } => {
            let near = |k: usize| (knots[k], points[k]);
            let start = direction(from, (0..=last.min(3)).map(near).collect());
            let stop = direction(to, (last.saturating_sub(3)..=last).rev().map(near).collect());
            solve([fixed(start)].into_iter().chain(inner).chain([fixed(stop)]).collect())
        }
        SplineEnd::Periodic => {
            let mut velocities = solve_around([row(last - 1, 0)].into_iter().chain(inner).collect());
            velocities.push(velocities[0]);
            velocities
        }
    };
    let velocities: Vec<_> = velocities.into_iter().map(|[x, y, _]| [x, y]).collect();
    Keys::new(knots, points, &velocities)
}

/// A row of a tridiagonal system with three right sides.
#[derive(Clone, Copy)]
struct Row {
    below: f64,
    diagonal: f64,
    above: f64,
    right: [f64; 3],
}

/// Elimination from the top down. The diagonal dominates in every row, so that no pivots need to be chosen.
fn solve(mut rows: Vec<Row>) -> Vec<[f64; 3]> {
    for k in 1..rows.len() {
        let before = rows[k - 1];
        let factor = rows[k].below / before.diagonal;
        rows[k].diagonal -= factor * before.above;
        rows[k].right = [0, 1, 2].map(|side| rows[k].right[side] - factor * before.right[side]);
    }
    let mut solution = vec![[0.0; 3]; rows.len()];
    let mut after = [0.0; 3];
    for (row, place) in rows.iter().zip(&mut solution).rev() {
        after = [0, 1, 2].map(|side| (row.right[side] - row.above * after[side]) / row.diagonal);
        *place = after;
    }
    solution
}

/// The same where the first row's `below` belongs to the last unknown and the last row's `above` to the first: the
/// corners are a product of two vectors, which the Sherman-Morrison formula takes out (the third right side).
fn solve_around(mut rows: Vec<Row>) -> Vec<[f64; 3]> {
    let last = rows.len() - 1;
    let (corner, other) = (rows[0].below, rows[last].above);
    let shift = -rows[0].diagonal;
    rows[0].diagonal -= shift;
    rows[last].diagonal -= corner * other / shift;
    rows[0].right[2] = shift;
    rows[last].right[2] = other;
    let mut solution = solve(rows);
    let fraction = corner / shift;
    let (top, bottom) = (solution[0], solution[last]);
    let scale = [0, 1].map(|side| (top[side] + fraction * bottom[side]) / (1.0 + top[2] + fraction * bottom[2]));
    for place in &mut solution {
        let [x, y] = plus([place[0], place[1]], -place[2], scale);
        *place = [x, y, 0.0];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contour;
    use crate::point::dot;

    /// Unevenly spaced points of a curve that is nowhere straight.
    fn wiggle(count: u32) -> Vec<Point> {
        (0..count).map(|k| f64::from(k) + 0.3 * f64::from(k % 3)).map(|a| [0.3 * a, (0.5 * a).sin()]).collect()
    }

    fn ends() -> [SplineEnd; 4] {
        [
            SplineEnd::Natural,
            SplineEnd::Clamped { from: Some(0.3), to: Some(-0.4) },
            SplineEnd::Clamped { from: None, to: Some(1.0) },
            SplineEnd::Periodic,
        ]
    }

    #[test]
    fn the_second_derivative_is_continuous_and_the_ends_hold() {
        for end in ends() {
            for count in 2..12 {
                if end == SplineEnd::Periodic && count < 3 {
                    continue;
                }
                let points = wiggle(count);
                let spline = Spline::through(&points, end).unwrap();
                assert!(points.iter().zip(spline.points()).all(|(&given, point)| given == point));
                let cubics: Vec<_> = (0..spline.keys.len() - 1).map(|k| spline.keys.cubic(k)).collect();
                let second = |k: usize, s: f64| cubics[k].velocity().rate(s).map(|side| side / cubics[k].width);
                let close = |a: Point, b: Point| assert!(dot(minus(a, b), minus(a, b)).sqrt() < 1e-12, "{a:?} {b:?}");
                for k in 1..cubics.len() {
                    close(cubics[k - 1].velocity().at(1.0), cubics[k].velocity().at(0.0));
                    close(second(k - 1, 1.0), second(k, 0.0));
                }
                let last = cubics.len() - 1;
                match end {
                    SplineEnd::Natural => {
                        close(second(0, 0.0), [0.0; 2]);
                        close(second(last, 1.0), [0.0; 2]);
                    }
                    SplineEnd::Clamped { from, .. } => {
                        let frame = spline.frame(0.0);
                        assert!((frame.speed - 1.0).abs() < 1e-14);
                        assert!(from.is_none_or(|from| (frame.alpha - from).abs() < 1e-14));
                    }
                    SplineEnd::Periodic => {
                        close(cubics[last].velocity().at(1.0), cubics[0].velocity().at(0.0));
                        close(second(last, 1.0), second(0, 0.0));
                    }
                }
            }
        }
    }

    #[test]
    fn a_closed_curve_may_repeat_its_first_point() {
        let mut points = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let once = Spline::through(&points, SplineEnd::Periodic).unwrap();
        points.push([1.0, -2.4e-16]);
        let twice = Spline::through(&points, SplineEnd::Periodic).unwrap();
        assert_eq!(once.range(), twice.range());
        assert_eq!(once.frame(0.3), twice.frame(0.3));
        assert_eq!(once.points().len(), 5);
    }
}
