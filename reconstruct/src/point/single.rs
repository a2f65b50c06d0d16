//! One contact from one sample: the rod is followed from its clamp to where its moment vanishes (Will 2014; Merker et al. 2020,
//! section 3), in closed form and with exact derivatives.

use super::clamp::Clamp;
use super::moment_zero::{MomentZero, NOISE_SIGMAS};
use super::no_contact::NoContact;
use super::touch::Touch;
use crate::numeric::{Number, propagate_covariance};
use nalgebra::{Matrix3, Vector3};
use rod_core::{Pose, Reactions, Rod, Units};

/// Rounding error allowed in the arc length (rod lengths) and in the phase criterion (dimensionless). Smaller: contacts exactly
/// at the tip of noise-free samples are called beyond it.
const SLACK: f64 = 1e-9;
/// The same in units of the machine epsilon of the number type; it exceeds `SLACK` in `f32` only.
const ROUNDINGS: f64 = 400.0;

/// The single contact that explains the `reactions` (N, N m) of `rod`, clamped at `pose` (m, radians): position, arc length,
/// tangent angle of the contour and force, and the covariance of the position. That follows from the `covariance` of
/// (f0x, f0y, m0z), in N^2, N^2 m, N^2 m^2; pass zero where it is not known, which saves half of the work.
///
/// A = f0y, B = -f0x, kappa(0) = -m0z. The contact is where the curvature vanishes first, with alpha = atan2(B, A) (Merker et
/// al. 2020, eq. 10 and 18). There is one exception: where K < 0 excludes a tangential contact and the curvature vanishes at
/// the tip again, as it does when a rod buckles in a notch, the contact is at the tip.
///
/// Accuracy: with exact reactions the point is exact to 1e-13 of the rod's length unless the force almost vanishes. In `f32` the
/// point differs from that in `f64` by at most 1e-6 of the rod's length (median 1e-7) in all samples of phases A and B of the
/// paper's scans. Under random loads it differs by less than 5e-6 in 99 %, and in all cases by less than 20 standard
/// deviations of the error that rounding the reactions to `f32` makes. No allocation.
///
/// ```
/// use nalgebra::Matrix3;
/// use rod_core::{Elastica, Load, Pose, Rod};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// let bent = Elastica::under_loads(rod.units(), clamp, &[Load { s: 0.08, force: 0.02, alpha: 1.2 }])?.0;
/// let found = rod_reconstruct::single(&rod, clamp, bent.reactions(), &Matrix3::zeros())?;
/// assert!((found.s - 0.08).abs() < 1e-14 && (found.x - bent.at(0.08).x).abs() < 1e-15);
/// assert!((found.alpha - 1.2).abs() < 1e-13 && (found.force - 0.02).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoContact`] where no single contact fits, with the reason.
pub fn single<T: Number>(
    rod: &Rod<T>,
    pose: Pose<T>,
    reactions: Reactions<T>,
    covariance: &Matrix3<T>,
) -> Result<Touch<T>, NoContact<T>> {
    single_with_friction(rod, pose, reactions, covariance, T::zero())
}

/// [`single`] of a rod that slides over the object with this coefficient of friction: positive where friction draws the rod from its clamp
/// towards its tip, as on a rod that is drawn back over the contact, negative where it is pushed on.
///
/// Where the contact is does not depend on friction. The contour's tangent does: the force is turned from the contour's normal by
/// atan(friction). So does the criterion that tells a contact that would have to pull: K <= 2 |F| sin rho.
///
/// ```
/// use nalgebra::Matrix3;
/// use rod_core::{Elastica, Load, Pose, Rod};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// // the force of a tip that slides with mu = 0.2 along a contour of tangent angle 1.2
/// let (mu, alpha) = (0.2_f64, 1.2);
/// let load = Load { s: 0.1, force: 0.02, alpha: alpha + mu.atan() };
/// let bent = Elastica::under_loads(rod.units(), clamp, &[load])?.0;
/// let found = rod_reconstruct::single_with_friction(&rod, clamp, bent.reactions(), &Matrix3::zeros(), mu)?;
/// assert!((found.x - bent.at(0.1).x).abs() < 1e-15 && (found.alpha - alpha).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoContact`] where no single contact fits, with the reason.
pub fn single_with_friction<T: Number>(
    rod: &Rod<T>,
    pose: Pose<T>,
    reactions: Reactions<T>,
    covariance: &Matrix3<T>,
    friction: T,
) -> Result<Touch<T>, NoContact<T>> {
    let (one, slack, sigmas) = (T::one(), T::from_f64(SLACK + ROUNDINGS * T::EPSILON), T::from_f64(NOISE_SIGMAS));
    let units = rod.units();
    let (clamp, covariance) = dimensionless(units, pose, reactions, covariance)?;
    let clamp = Clamp { friction, ..clamp };
    // the derivatives are half of the work, and needed for the covariance only
    let noisy = covariance.iter().any(|v| *v != T::zero());
    let first = MomentZero::first(&clamp, &covariance, noisy)?;
    let noise = |gradient: &Vector3<T>| {
        if noisy { sigmas * propagate_covariance(&gradient.transpose(), &covariance).x.sqrt() } else { T::zero() }
    };
    let beyond = |found: &MomentZero<T>| noise(&found.s_by_reactions) + slack;
    let (k, gradient) = clamp.criterion();
    let excess = noise(&gradient) + slack * (one + first.force);
    let tip = if k < -excess { first.later(&clamp, noisy) } else { None };
    let found = tip.filter(|tip| (tip.s - one).abs() <= beyond(tip)).unwrap_or(first);
    let touch = found.touch(&covariance).in_units(units);
    if found.s > one + beyond(&found) {
        return Err(NoContact::BeyondTip(touch));
    }
    if k > excess { Err(NoContact::Pulling(touch)) } else { Ok(touch) }
}

/// The clamp and the covariance of its reactions, dimensionless, if all numbers are finite.
pub(super) fn dimensionless<T: Number>(
    units: Units<T>,
    pose: Pose<T>,
    reactions: Reactions<T>,
    covariance: &Matrix3<T>,
) -> Result<(Clamp<T>, Matrix3<T>), NoContact<T>> {
    let clamp = Clamp::new(units, pose, reactions);
    let unit = Vector3::new(units.force, units.force, units.moment).map(T::recip);
    let covariance = Matrix3::from_fn(|i, j| unit[i] * covariance[(i, j)] * unit[j]);
    if clamp.is_finite() && covariance.iter().all(|v| v.is_finite()) {
        Ok((clamp, covariance))
    } else {
        Err(NoContact::NotFinite)
    }
}
