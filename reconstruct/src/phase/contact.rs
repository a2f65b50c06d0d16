//! The single contact of a sample whose phase is known.

use super::label::Label;
use crate::point::{Clamp, Inverse, NoContact, Touch};
use crate::scan::{LocalCubic, Noise};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Gauss-Newton steps of the projection onto the condition, which is nearly linear within the noise.
const STEPS: usize = 2;

/// The contact at a sample of phase A or B, dimensionless: from the fit about it, or from the sample itself where that is clean.
pub(crate) fn contact<I: Inverse>(
    rod: &I,
    sample: &Clamp,
    tau: f64,
    fit: &LocalCubic,
    noise: &Noise,
    label: Label,
) -> Result<Touch, NoContact> {
    if noise.is_clean() {
        return constrained_contact(rod, sample, &Matrix3::from_diagonal(&noise.variance), label);
    }
    let estimate = fit.at(tau);
    constrained_contact(rod, &estimate.clamp, &estimate.covariance(), label)
}

/// The contact of reactions with this covariance (dimensionless) in phase A or B.
///
/// A requires that the moment vanishes at the tip, B that the criterion K does. The reactions are projected onto the condition by
/// least squares, which removes a third of their noise. Reactions without noise stay as they are.
pub(crate) fn constrained_contact<I: Inverse>(
    rod: &I,
    clamp: &Clamp,
    covariance: &Matrix3<f64>,
    label: Label,
) -> Result<Touch, NoContact> {
    let mut clamp = *clamp;
    let mut left = *covariance;
    if covariance.trace() > 0.0 {
        let measured = clamp.reactions;
        for _ in 0..STEPS {
            let (value, gradient) = condition(rod, &clamp, label)?;
            let carried = covariance * gradient;
            let variance = gradient.dot(&carried);
            if variance > 0.0 {
                // the point of the linearised condition that is nearest to the measured reactions
                let off = value + gradient.dot(&(measured - clamp.reactions));
                clamp.reactions = measured - carried * (off / variance);
                left = covariance - carried * carried.transpose() / variance;
            }
        }
    }
    let found = if label == Label::A { rod.of_tip(&clamp) } else { rod.first(&clamp) };
    let mut touch = found?.touch(&left);
    // Where the force is about as small as its noise, the point is not linear in it any more. The term of second order is
    // about the square of the relative error.
    let direction = Vector3::new(clamp.reactions.x, clamp.reactions.y, 0.0) / touch.force;
    let relative = direction.dot(&(covariance * direction)) / (touch.force * touch.force);
    touch.covariance += Matrix2::identity() * (relative * relative);
    Ok(touch)
}

/// The number that vanishes in the phase, and its derivatives by the reactions.
fn condition<I: Inverse>(rod: &I, clamp: &Clamp, label: Label) -> Result<(f64, Vector3<f64>), NoContact> {
    if label == Label::B {
        let first = if I::UNIFORM { None } else { Some(rod.first(clamp)?) };
        return rod.criterion(clamp, first.as_ref()).ok_or(NoContact::NoMomentZero);
    }
    let found = rod.of_tip(clamp)?;
    Ok((found.s - 1.0, found.s_by_reactions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{Elastica, Load, Pose, Uniform, Units};

    #[test]
    fn the_condition_is_met_and_the_covariance_shrinks() {
        let clamp_at = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        let load = Load { s: 1.0, force: 2.0, alpha: 1.0 };
        let bent = Elastica::under_loads(Units::ONE, clamp_at, &[load]).unwrap().0;
        let mut clamp = Clamp::new(Units::ONE, clamp_at, bent.reactions());
        let covariance = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1e-5));
        clamp.reactions += Vector3::new(1e-3, -5e-4, 2e-3);
        let free = Uniform.first(&clamp).unwrap().touch(&covariance);
        let tip = constrained_contact(&Uniform, &clamp, &covariance, Label::A).unwrap();
        assert!((tip.s - 1.0).abs() < 1e-6 && (free.s - 1.0).abs() > 1e-4, "{} {}", tip.s, free.s);
        assert!(tip.covariance.trace() < free.covariance.trace());
        let truth = bent.at(1.0);
        assert!((tip.x - truth.x).hypot(tip.y - truth.y) < (free.x - truth.x).hypot(free.y - truth.y));
    }
}
