//! The dimensionless clamps that give way.

use super::{Clamp, ClampLaw};
use crate::pose::Pose;

/// A clamp on springs, dimensionless: (x(0), y(0), phi(0)) = pose - compliance (f0x, f0y, m0z).
///
/// [`ElasticClamp`](crate::ElasticClamp) makes it from SI units. The springs keep the directions of the world when the support turns.
///
/// ```
/// use rod_core::{Elastic, Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
/// // the tip of an upright rod on a frictionless wall x = 0.5 that pushes to +x
/// struct Wall;
/// impl Supports for Wall {
///     fn count(&self) -> usize { 1 }
///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
///     fn support(&self, _: usize, t: f64) -> Support {
///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
///     }
/// }
/// let pose = Pose { x: 0.499, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
/// // a spring of 3 E I / L against turning
/// let clamp = Elastic { pose, compliance: [[0.0; 3], [0.0; 3], [0.0, 0.0, 1.0 / 3.0]] };
/// let problem = MultiPoint { rod: Uniform, clamp, supports: &Wall };
/// let mut u = [1.0, 0.001, 1.57];
/// assert!(solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
/// // it is as soft as the rod: w = f / 3 + f / 3
/// assert!((u[1] - 1.5 * 0.001).abs() < 1e-8);
/// assert!((problem.base(&u).phi - pose.phi + u[1] / 3.0).abs() < 1e-8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// The support.
    pub pose: Pose,
    /// Displacement (x, y, phi) per reaction (f0x, f0y, m0z), row by row: symmetric, positive semidefinite.
    pub compliance: [[f64; 3]; 3],
}

impl Clamp for Elastic {
    fn pose(&self) -> Pose {
        self.pose
    }
    #[inline(always)]
    fn law(&self) -> Option<ClampLaw> {
        let is_rigid = self.compliance == [[0.0; 3]; 3];
        (!is_rigid).then_some(ClampLaw { compliance: self.compliance, torque: None })
    }
}

/// A clamp that holds the position and leaves the slope angle free, under a given torque, dimensionless.
///
/// Without a torque the forces of the contacts together pass through the pivot. Two contacts or more can balance so. One contact alone
/// cannot carry a force: the solution is then the straight rod that just touches, with the force 0. Where the contact's normal goes
/// through the pivot any force holds the rod: a solve ends as [`SolveStatus::Singular`](crate::SolveStatus::Singular), or, where
/// rounding hides that, with a condition number near 1e16 in its report.
///
/// ```
/// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pivot, Pose, Support, Supports, Uniform, solve};
/// struct Wall; // x = 0.5, pushes the tip to +x
/// impl Supports for Wall {
///     fn count(&self) -> usize { 1 }
///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
///     fn support(&self, _: usize, t: f64) -> Support {
///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
///     }
/// }
/// // a torque of 0.1 E I / L turns the rod against the wall
/// let up = std::f64::consts::FRAC_PI_2;
/// let clamp = Pivot { pose: Pose { x: 0.5, y: 0.0, phi: up }, torque: 0.1 };
/// let problem = MultiPoint { rod: Uniform, clamp, supports: &Wall };
/// let mut u = [1.0, 0.1, up];
/// assert!(solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
/// // the force has the lever t, and a simply supported rod turns by T L / 3 E I
/// assert!((u[1] * u[0] - 0.1).abs() < 1e-14);
/// assert!((problem.base(&u).phi - up - 0.1 / 3.0).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot {
    /// The pivot. Its `phi` has no effect.
    pub pose: Pose,
    /// The moment m0z that acts on the rod at the pivot, E I / L.
    pub torque: f64,
}

impl Clamp for Pivot {
    fn pose(&self) -> Pose {
        self.pose
    }
    fn law(&self) -> Option<ClampLaw> {
        Some(ClampLaw { compliance: [[0.0; 3]; 3], torque: Some(self.torque) })
    }
}
