//! The lever arm, from loads at the clamp.

use super::GeometryError;
use crate::sample::Wrench;
use nalgebra::{Matrix3, Vector3};

/// The force directions must differ by so much, as a sine: below, the arm along the force is a guess.
const LEAST_SPREAD: f64 = 0.05;

/// Where the clamp is, as seen from the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeverArm {
    /// From the sensor's origin to the clamp, in the sensor's axes, m.
    pub lever: [f64; 3],
    /// Standard deviations of its components, m.
    pub sigma: [f64; 3],
    /// Root mean square of the moments' components that remain, N m.
    pub residual: f64,
}

/// The lever arm from wrenches that the sensor measured, without its zero, while forces pulled at the clamp and no moment did:
/// weights on a thread in several directions, or in several positions of the sensor. Least squares of M = d x F.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::tests::cross;
    use proptest::prelude::*;
    use std::array::from_fn;

    /// Between -0.5 and 0.5, scaled to variance 1: a number mixed (SplitMix64).
    fn noise(n: u64) -> f64 {
        let z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) as f64 / u64::MAX as f64 - 0.5) * 12.0_f64.sqrt()
    }

    proptest! {
        #[test]
        fn finds_what_was_put_in(
            lever in proptest::array::uniform3(-0.1..0.1),
            forces in proptest::collection::vec(proptest::array::uniform3(-2.0..2.0), 4..20),
        ) {
            let loads: Vec<Wrench> = forces.iter().map(|f| Wrench { force: *f, torque: cross(lever, *f) }).collect();
            if let Ok(found) = fit_lever_arm(&loads) {
                prop_assert!(found.lever.iter().zip(lever).all(|(a, b)| (a - b).abs() < 1e-11), "{found:?}");
                // and the clamp is then free of moments
                let frame = crate::Frame::same().with_origin(found.lever).unwrap();
                let there = frame.wrench(&loads[0]);
                let free = there.torque.iter().all(|m| m.abs() < 1e-10);
                prop_assert!(free);
            }
        }
    }

    #[test]
    fn its_standard_deviation_is_that_of_many_fits() {
        let lever = [0.01, -0.02, 0.03];
        let fit = |seed: u64| {
            let mut n = 1000 * seed;
            let loads: Vec<Wrench> = (0..12_u32)
                .map(|i| {
                    let angle = f64::from(i);
                    let force = [0.5 * angle.cos(), 0.5 * angle.sin(), if i % 3 == 0 { 0.3 } else { -0.1 }];
                    let exact = cross(lever, force);
                    let torque = from_fn(|k| {
                        n += 1;
                        exact[k] + 1e-4 * noise(n)
                    });
                    Wrench { force, torque }
                })
                .collect();
            fit_lever_arm(&loads).unwrap()
        };
        let count = 400.0;
        let fits: Vec<LeverArm> = (1..=400).map(fit).collect();
        for (i, exact) in lever.into_iter().enumerate() {
            let scatter = (fits.iter().map(|f| (f.lever[i] - exact).powi(2)).sum::<f64>() / count).sqrt();
            let stated = (fits.iter().map(|f| f.sigma[i].powi(2)).sum::<f64>() / count).sqrt();
            assert!((scatter / stated - 1.0).abs() < 0.2, "{scatter} {stated}");
        }
        let residual = fits.iter().map(|f| f.residual).sum::<f64>() / count;
        assert!((residual - 1e-4).abs() < 1e-5, "{residual}");
    }

    #[test]
    fn refuses() {
        let load = Wrench { force: [0.0, -0.5, 0.0], torque: [0.0, 0.0, -1e-3] };
        assert_eq!(fit_lever_arm(&[load]), Err(GeometryError::Few { found: 1 }));
        let error = fit_lever_arm(&[load, load * 2.0, -load]).unwrap_err().to_string();
        assert!(error.starts_with("the forces differ by a sine of 0.000 only"), "{error}");
        assert_eq!(fit_lever_arm(&[Wrench::default(); 3]), Err(GeometryError::Parallel { spread: 0.0 }));
        let broken = Wrench { force: [f64::NAN, 0.0, 0.0], ..load };
        assert_eq!(fit_lever_arm(&[load, broken]), Err(GeometryError::NotFinite { load: 2 }));
    }
}
