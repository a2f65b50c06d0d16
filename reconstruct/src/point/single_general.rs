//! One contact from one sample for rods without a closed form: tapered, bent at rest, of any law of curvature.

use super::clamp::Clamp;
use super::moment_zero::{NOISE_SIGMAS, is_free};
use super::no_contact::NoContact;
use super::single::dimensionless;
use super::touch::Touch;
use crate::numeric::propagate_covariance;
use nalgebra::{Matrix2x3, Matrix3, Vector3};
use rod_core::{Cut, Pose, Propagator, Reactions, RodError, Units, find_root};

/// Length of the steps (rod lengths) in which the moment is followed. Two zeros within one step may be missed; the work grows
/// with its inverse.
const STEP: f64 = 1.0 / 64.0;
/// Arc length (rod lengths) to which the moment is followed, as far as the rod's law is defined beyond the tip. Zeros between the
/// tip and there give [`NoContact::BeyondTip`].
const REACH: f64 = 1.5;
/// Step of the central differences by the reactions, relative to 1 + |reactions|. Their truncation error, the square of the step,
/// is as large as the error that an integrator exact to 1e-12 makes in the quotient: larger and smaller steps are worse.
const DIFFERENCE: f64 = 1e-4;
/// Error that an integrator leaves in the arc length (rod lengths) and in the angle between rod and contour (radians).
const SLACK: f64 = 1e-6;

/// Why there is no contact.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeneralError {
    /// No single contact fits.
    #[error("{0}")]
    NoContact(#[from] NoContact),
    /// The propagator failed before the tip.
    #[error("{0}")]
    Rod(#[from] RodError),
}

/// [`single`](crate::single) for rods without a closed form: the single contact that explains the `reactions` (N, N m) of a rod
/// clamped at `pose` (m, radians), with the covariance of its position from the `covariance` of (f0x, f0y, m0z). `units` make
/// the dimensionless `rod` one with a length and a stiffness. The criterion K does not hold for such rods; a contact that
/// would have to pull is recognised by the angle between rod and contour.
///
/// The zeros of the moment are bracketed in steps of 1/64 of the rod's length, in which two zeros may be missed, and found by
/// Brent's method: they are as accurate as the propagator. The covariance is computed from central differences, and exact
/// to 1e-6 of its size with a propagator exact to 1e-12.
///
/// ```
/// use nalgebra::Matrix3;
/// use rod_core::{GeneralElastica, Load, Method, Ode, Pose, Units};
/// let whisker = Ode::with_law(|s, m| m / (1.0 - 0.8 * s).powi(4), Method::Dop853, 1e-12)?;
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// let load = Load { s: 0.7, force: 0.1, alpha: 1.2 };
/// let bent = GeneralElastica::under_loads(&whisker, Units::ONE, clamp, &[load])?.0;
/// let found = rod_reconstruct::single_general(&whisker, Units::ONE, clamp, bent.reactions(), &Matrix3::zeros())?;
/// assert!((found.s - 0.7).abs() < 1e-9 && (found.x - bent.at(0.7)?.x).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`GeneralError`].
pub fn single_general(
    rod: &dyn Propagator,
    units: Units,
    pose: Pose,
    reactions: Reactions,
    covariance: &Matrix3<f64>,
) -> Result<Touch, GeneralError> {
    let (clamp, covariance) = dimensionless(units, pose, reactions, covariance)?;
    if is_free(&clamp, &covariance) {
        return Err(NoContact::Free.into());
    }
    let zeros = zeros(rod, &clamp)?;
    let first = *zeros.first().ok_or(NoContact::NoMomentZero)?;
    let first = ContactAtZero::new(rod, &clamp, first, &covariance)?;
    let mut found = first;
    if first.pressing > first.pressing_noise {
        for &zero in zeros[1..].iter().filter(|zero| zero.0 < 1.0 + STEP && zero.0 > 1.0 - STEP) {
            let later = ContactAtZero::new(rod, &clamp, zero, &covariance)?;
            if (later.touch.s - 1.0).abs() <= later.s_noise {
                found = later;
            }
        }
    }
    let touch = found.touch.in_units(units);
    if found.touch.s > 1.0 + found.s_noise {
        return Err(NoContact::BeyondTip(touch).into());
    }
    if found.pressing < -found.pressing_noise { Err(NoContact::Pulling(touch).into()) } else { Ok(touch) }
}

/// All zeros of the moment. Where the rod's law ends beyond the tip, the search ends, too.
fn zeros(rod: &dyn Propagator, clamp: &Clamp) -> Result<Vec<(f64, Cut)>, RodError> {
    let [a, b] = clamp.force();
    let mut start = cut(clamp);
    let mut zeros = Vec::new();
    if start.moment == 0.0 {
        zeros.push((0.0, start));
    }
    let steps = (REACH / STEP).round() as u32;
    for k in 0..steps {
        let s = f64::from(k) * STEP;
        let end = match rod.advance(s, &start, a, b, STEP) {
            Err(error) if s + STEP <= 1.0 => return Err(error),
            Err(_) => break,
            Ok(end) => end,
        };
        if start.moment * end.moment < 0.0 || (end.moment == 0.0 && start.moment != 0.0) {
            let moment = |length: f64| Ok(rod.advance(s, &start, a, b, length)?.moment);
            let at = find_root("moment", moment, 0.0, STEP, 0.0)?.at;
            zeros.push((s + at, rod.advance(s, &start, a, b, at)?));
        }
        start = end;
    }
    Ok(zeros)
}

fn cut(clamp: &Clamp) -> Cut {
    Cut { x: clamp.pose.x, y: clamp.pose.y, phi: clamp.pose.z, moment: -clamp.reactions.z }
}

/// A zero of the moment as a contact, dimensionless.
#[derive(Clone, Copy)]
struct ContactAtZero {
    touch: Touch,
    /// Bound of the error of its arc length.
    s_noise: f64,
    /// Sine of the angle from the contour to the rod: positive at the tip, 0 at a tangential contact.
    pressing: f64,
    /// Bound of its error.
    pressing_noise: f64,
}

impl ContactAtZero {
    fn new(
        rod: &dyn Propagator,
        clamp: &Clamp,
        (s, at): (f64, Cut),
        covariance: &Matrix3<f64>,
    ) -> Result<Self, RodError> {
        let [a, b] = clamp.force();
        let (force, alpha) = (a.hypot(b), b.atan2(a));
        let (sin, cos) = at.phi.sin_cos();
        let mut position = Matrix2x3::zeros();
        let (mut by_s, mut by_angle) = (Vector3::zeros(), Vector3::zeros());
        if covariance.iter().any(|&v| v != 0.0) {
            let bend = rod.curvature(s, 0.0);
            let moment_by_s = a * cos + b * sin;
            // derivatives of alpha = atan2(-f0x, f0y)
            let turn = Vector3::new(-a, -b, 0.0) / (force * force);
            for c in 0..3 {
                let step = DIFFERENCE * (1.0 + clamp.reactions.norm());
                let end = |step: f64| {
                    let mut clamp = *clamp;
                    clamp.reactions[c] += step;
                    let [a, b] = clamp.force();
                    rod.advance(0.0, &cut(&clamp), a, b, s)
                };
                let (plus, minus) = (end(step)?, end(-step)?);
                let by = |value: fn(&Cut) -> f64| (value(&plus) - value(&minus)) / (2.0 * step);
                // the zero slides along the rod so that the moment there stays 0
                let slide = -by(|cut| cut.moment) / moment_by_s;
                position[(0, c)] = by(|cut| cut.x) + cos * slide;
                position[(1, c)] = by(|cut| cut.y) + sin * slide;
                by_s[c] = slide;
                by_angle[c] = by(|cut| cut.phi) + bend * slide - turn[c];
            }
        }
        let noise = |gradient: &Vector3<f64>| {
            NOISE_SIGMAS * propagate_covariance(&gradient.transpose(), covariance).x.sqrt() + SLACK
        };
        let covariance = propagate_covariance(&position, covariance);
        let touch = Touch { s, x: at.x, y: at.y, alpha, force, covariance, systematic: nalgebra::Matrix2::zeros() };
        let (pressing, tilt) = (at.phi - alpha).sin_cos();
        Ok(Self { touch, s_noise: noise(&by_s), pressing, pressing_noise: noise(&(by_angle * tilt)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::single;
    use rod_core::{Elastica, GeneralElastica, Load, Method, Ode, Rod, Uniform};

    const CLAMP: Pose = Pose { x: 0.3, y: -0.2, phi: 1.5 };

    fn noise() -> Matrix3<f64> {
        Matrix3::new(1e-6, 2e-7, 0.0, 2e-7, 2e-6, -1e-7, 0.0, -1e-7, 5e-7)
    }

    /// A whisker that tapers to a fifth of its diameter.
    fn whisker() -> impl Propagator {
        Ode::with_law(|s, m| m / (1.0 - 0.8 * s).powi(4), Method::Dop853, 1e-13).unwrap()
    }

    #[test]
    fn a_uniform_rod_is_as_in_closed_form() {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let ode = Ode::uniform(Method::Dop853, 1e-13).unwrap();
        let propagators: [(&dyn Propagator, f64); 2] = [(&Uniform, 1e-12), (&ode, 1e-10)];
        for (s, force, alpha) in [(1.0, 1.5, 1.0), (0.8, 2.0, 1.1), (0.6, 0.5, 0.7), (1.0, 6.0, 0.4)] {
            let bent = Elastica::under_loads(Units::ONE, CLAMP, &[Load { s, force, alpha }]).unwrap().0;
            for covariance in [Matrix3::zeros(), noise()] {
                let exact = single(&rod, CLAMP, bent.reactions(), &covariance);
                for (propagator, tolerance) in propagators {
                    let found = single_general(propagator, Units::ONE, CLAMP, bent.reactions(), &covariance);
                    let (exact, found) = match (&exact, &found) {
                        (Ok(exact), Ok(found)) => (*exact, *found),
                        (Err(exact), Err(GeneralError::NoContact(found))) => {
                            assert_eq!(std::mem::discriminant(exact), std::mem::discriminant(found));
                            (exact.touch().unwrap(), found.touch().unwrap())
                        }
                        other => panic!("{other:?}"),
                    };
                    assert!((exact.x - found.x).hypot(exact.y - found.y) < tolerance);
                    assert!((exact.s - found.s).abs() < tolerance && exact.alpha == found.alpha);
                    let off = (exact.covariance - found.covariance).norm();
                    assert!(off <= 1e-6 * exact.covariance.norm(), "{off:e} of {:e}", exact.covariance.norm());
                }
            }
        }
    }

    #[test]
    fn the_tip_and_the_flank_of_a_whisker() {
        let whisker = whisker();
        let bent = |s: f64, force: f64, alpha: f64| {
            GeneralElastica::under_loads(&whisker, Units::ONE, CLAMP, &[Load { s, force, alpha }]).unwrap().0
        };
        // the flank lies along the contour: alpha is the slope there
        let slope = |alpha: f64| Ok(bent(0.6, 0.15, alpha).at(0.6)?.phi - alpha);
        let along = find_root("angle", slope, 0.5, 1.5, 1e-13).unwrap().at;
        for (s, force, alpha) in [(1.0, 0.03, 1.2), (1.0, 0.06, 0.9), (0.6, 0.15, along)] {
            let bent = bent(s, force, alpha);
            let found = single_general(&whisker, Units::ONE, CLAMP, bent.reactions(), &noise()).unwrap();
            let truth = bent.at(s).unwrap();
            assert!((found.x - truth.x).hypot(found.y - truth.y) < 1e-9, "{:e}", found.x - truth.x);
            assert!((found.s - s).abs() < 1e-8 && (found.alpha - alpha).abs() < 1e-10, "{:e}", found.s - s);
            assert!((found.force - force).abs() < 1e-10);
        }
        // it would be elsewhere, were the rod taken for a uniform one
        let bent = bent(0.6, 0.15, along);
        let uniform = single(&Rod::new(1.0, 1.0).unwrap(), CLAMP, bent.reactions(), &noise());
        let uniform = uniform.or_else(|reason| reason.touch().ok_or(reason)).unwrap();
        let truth = bent.at(0.6).unwrap();
        let off = (uniform.x - truth.x).hypot(uniform.y - truth.y);
        assert!(off > 1e-3, "{off:e}");
    }

    #[test]
    fn why_there_is_none() {
        let none = Matrix3::zeros();
        let at = |f0x: f64, f0y: f64, m0z: f64| {
            single_general(&whisker(), Units::ONE, CLAMP, Reactions { f0x, f0y, m0z }, &none).unwrap_err()
        };
        assert_eq!(at(0.0, 0.0, 0.0), NoContact::Free.into());
        assert_eq!(at(0.0, 0.0, 1.0), NoContact::NoMomentZero.into());
        assert_eq!(at(f64::NAN, 0.0, 1.0), NoContact::NotFinite.into());
        let uniform = |f0x: f64, f0y: f64, m0z: f64| {
            single_general(&Uniform, Units::ONE, CLAMP, Reactions { f0x, f0y, m0z }, &none).unwrap_err()
        };
        assert!(matches!(uniform(1.0, 0.0, -1.2), GeneralError::NoContact(NoContact::BeyondTip(_))));
    }
}
