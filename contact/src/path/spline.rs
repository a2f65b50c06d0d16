//! A smooth path through poses.

use super::{Path, PathPoint, check};
use crate::error::ContactError;
use rod_core::Pose;

/// A natural cubic spline through poses: position and angle have continuous first and second derivatives.
///
/// Its parameter is the length of the polygon through the poses, m, or radians where the clamp only turns.
///
/// ```
/// use rod_contact::{ClampSpline, Path};
/// use rod_core::Pose;
/// let pose = |x: f64| Pose { x, y: 0.01 * x.sin(), phi: 1.0 + 0.1 * x };
/// let spline = ClampSpline::through(&[pose(0.0), pose(1.0), pose(2.0), pose(3.0)])?;
/// let end = spline.point(spline.length()).pose;
/// assert!((end.x - 3.0).abs() < 1e-14 && (end.phi - 1.3).abs() < 1e-14);
/// # Ok::<(), rod_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ClampSpline {
    knots: Vec<f64>,
    /// x, y and angle at the knots, and their second derivatives.
    values: Vec<[f64; 3]>,
    bends: Vec<[f64; 3]>,
}

impl ClampSpline {
    /// The spline through poses (m, m, radians), in order.
    ///
    /// # Errors
    /// [`ContactError::NotFinite`], [`ContactError::Angle`], [`ContactError::NoPath`] where two neighbours have the same
    /// position (unless all have), [`ContactError::NoLegs`] of fewer than two.
    pub fn through(poses: &[Pose]) -> Result<Self, ContactError> {
        for pose in poses {
            check(*pose, ["pose.x", "pose.y", "pose.phi"])?;
        }
        let first = *poses.first().filter(|_| poses.len() > 1).ok_or(ContactError::NoLegs)?;
        let turns_only = poses.iter().all(|pose| (pose.x, pose.y) == (first.x, first.y));
        let mut knots = vec![0.0];
        for pair in poses.windows(2) {
            let way = (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y);
            let way = if turns_only { (pair[1].phi - pair[0].phi).abs() } else { way };
            let last = knots[knots.len() - 1];
            if way <= 0.0 {
                return Err(ContactError::NoPath { pose: pair[0] });
            }
            knots.push(last + way);
        }
        let values: Vec<_> = poses.iter().map(|pose| [pose.x, pose.y, pose.phi]).collect();
        let bends = bends(&knots, &values);
        Ok(Self { knots, values, bends })
    }
}

/// Second derivatives at the knots, zero at both ends: Thomas's algorithm for the tridiagonal system of continuous slopes.
fn bends(knots: &[f64], values: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let n = knots.len();
    let mut bends = vec![[0.0; 3]; n];
    let mut above = vec![0.0; n];
    for i in 1..n - 1 {
        let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
        let pivot = 2.0 * (before + after) - before * above[i - 1];
        above[i] = after / pivot;
        for k in 0..3 {
            let slopes = [(values[i][k] - values[i - 1][k]) / before, (values[i + 1][k] - values[i][k]) / after];
            bends[i][k] = (6.0 * (slopes[1] - slopes[0]) - before * bends[i - 1][k]) / pivot;
        }
    }
    for i in (1..n - 1).rev() {
        let after = bends[i + 1];
        for (bend, after) in bends[i].iter_mut().zip(after) {
            *bend -= above[i] * after;
        }
    }
    bends
}

impl Path for ClampSpline {
    fn point(&self, t: f64) -> PathPoint {
        let i = self.knots.partition_point(|knot| *knot <= t).clamp(1, self.knots.len() - 1) - 1;
        let h = self.knots[i + 1] - self.knots[i];
        let u = (t - self.knots[i]) / h;
        let v = 1.0 - u;
        let value = |k: usize| {
            let [a, b] = [self.bends[i][k], self.bends[i + 1][k]];
            let [from, to] = [self.values[i][k], self.values[i + 1][k]];
            let bent = h * h / 6.0 * ((v * v * v - v) * a + (u * u * u - u) * b);
            let slope = (to - from) / h + h / 6.0 * ((1.0 - 3.0 * v * v) * a + (3.0 * u * u - 1.0) * b);
            (v * from + u * to + bent, slope)
        };
        let [(x, by_x), (y, by_y), (phi, by_phi)] = [0, 1, 2].map(value);
        PathPoint { pose: Pose { x, y, phi }, rate: Pose { x: by_x, y: by_y, phi: by_phi } }
    }

    fn length(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_through_the_poses_and_is_smooth() {
        let pose = |x: f64| Pose { x, y: (2.0 * x).sin(), phi: x * x };
        let poses = [0.0, 0.3, 0.5, 1.1, 1.2].map(pose);
        let spline = ClampSpline::through(&poses).unwrap();
        for (knot, pose) in spline.knots.iter().zip(poses) {
            let there = spline.point(*knot).pose;
            assert!((there.x - pose.x).abs() < 1e-14 && (there.y - pose.y).abs() < 1e-14);
            assert!((there.phi - pose.phi).abs() < 1e-14);
            let e = 1e-6;
            let [before, after] = [spline.point(knot - e), spline.point(knot + e)];
            assert!((after.pose.y - before.pose.y - 2.0 * e * spline.point(*knot).rate.y).abs() < 1e-12);
            // bends are continuous: slopes change by O(e)
            assert!((after.rate.y - before.rate.y).abs() < 1e-4, "at {knot}");
        }
        let again = [poses[0], poses[1], poses[1]];
        assert!(matches!(ClampSpline::through(&again), Err(ContactError::NoPath { .. })));
    }
}
