//! The lever arm, from loads at the clamp.

use super::GeometryError;
use crate::sample::Wrench;
use nalgebra::{Matrix3, Vector3};

/// Least spread of the directions of the forces, as a sine. Below it the arm along the forces is mostly noise.
const LEAST_SPREAD: f64 = 0.05;

/// The position of the clamp relative to the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeverArm {
    /// From the sensor's origin to the clamp, in the sensor's axes, m.
    pub lever: [f64; 3],
    /// Standard deviations of its components, m.
    pub sigma: [f64; 3],
    /// Root mean square of the residual components of the moments, N m.
    pub residual: f64,
}

/// The lever arm by least squares of M = d x F, from wrenches that the sensor measured (less its zero) while forces, and no
/// moments, pulled at the clamp: weights on a thread in several directions, or with the sensor in several positions.
///
/// ```
/// use rod_hw::{Wrench, fit_lever_arm};
/// // 50 g at the clamp, 12 mm along z and 3 mm along x from the sensor; pulled along x, y and z
/// let loads = [
///     Wrench { force: [0.49, 0.0, 0.0], torque: [0.0, 5.88e-3, 0.0] },
///     Wrench { force: [0.0, 0.49, 0.0], torque: [-5.88e-3, 0.0, 1.47e-3] },
///     Wrench { force: [0.0, 0.0, 0.49], torque: [0.0, -1.47e-3, 0.0] },
/// ];
/// let found = fit_lever_arm(&loads)?;
/// assert!((found.lever[0] - 3e-3).abs() < 1e-12 && (found.lever[2] - 12e-3).abs() < 1e-12);
/// assert!(found.residual < 1e-12);
/// # Ok::<(), rod_hw::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError`]; forces in one direction leave the arm along it open.
pub fn fit_lever_arm(loads: &[Wrench]) -> Result<LeverArm, GeometryError> {
    if loads.len() < 2 {
        return Err(GeometryError::Few { found: loads.len() });
    }
    if let Some(load) = loads.iter().position(|load| !load.is_finite()) {
        return Err(GeometryError::NotFinite { load: load + 1 });
    }
    // M = d x F = -[F]x d has the normal equations  sum (F.F - F F') d = sum F x M
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (force, torque) in loads.iter().map(vectors) {
        normal += Matrix3::identity() * force.norm_squared() - force * force.transpose();
        right += force.cross(&torque);
    }
    // the trace is 2 sum F.F; of nearly parallel forces one eigenvalue, about sum F.F sin^2, is far below the two others
    let size = 0.5 * normal.trace();
    let spread = (normal.determinant() / size.powi(3)).max(0.0).sqrt();
    let inverse = normal.cholesky().filter(|_| spread >= LEAST_SPREAD).map(|cholesky| cholesky.inverse());
    let inverse = inverse.ok_or(GeometryError::Parallel { spread: if spread.is_nan() { 0.0 } else { spread } })?;
    let lever = inverse * right;
    let squares: f64 =
        loads.iter().map(vectors).map(|(force, torque)| (torque - lever.cross(&force)).norm_squared()).sum();
    let equations = 3.0 * loads.len() as f64;
    // the component of a moment along its force is noise whatever the arm is, so that none is lost but to the arm
    let variance = squares / (equations - 3.0);
    let sigma = inverse.diagonal().map(|element| (variance * element).max(0.0).sqrt());
    Ok(LeverArm { lever: lever.into(), sigma: sigma.into(), residual: (squares / equations).sqrt() })
}

fn vectors(load: &Wrench) -> (Vector3<f64>, Vector3<f64>) {
    (load.force.into(), load.torque.into())
}
