//! How the criteria of a place, and the contact point there, depend on the errors that all samples share.

use super::correction::{Correction, Frame};
use super::source::{Errors, Joint, SOURCES, Source};
use crate::phase::{CRITERIA, Criterion, Label, constrained_contact};
use crate::point::{Clamp, Inverse, MomentZero};
use crate::scan::LocalEstimate;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};

/// Pose, reactions, natural curvature, friction, and rates of pose and reactions.
const INPUTS: usize = 14;
/// The first eight of them determine the contact point.
pub(super) const POINT_INPUTS: usize = 8;
/// The first of the angle of the clamp, of the reactions, of the natural curvature, of friction, of the rates of the pose and of those of the
/// reactions.
const ANGLE: usize = 2;
const REACTIONS: usize = 3;
const NATURAL: usize = 6;
const FRICTION: usize = 7;
const MOTION: usize = 8;
const RATES: usize = 11;
/// Step of differences by inputs of size 1: truncation and rounding make an error of some 1e-7 relative, far below that of any budget.
const STEP: f64 = 1e-7;

type Inputs = SVector<f64, INPUTS>;

fn inputs((clamp, rate): &(Clamp, Clamp)) -> Inputs {
    let (p, r, v, w) = (&clamp.pose, &clamp.reactions, &rate.pose, &rate.reactions);
    let (n, f) = (clamp.natural, clamp.friction);
    Inputs::from([p.x, p.y, p.z, r.x, r.y, r.z, n, f, v.x, v.y, v.z, w.x, w.y, w.z])
}

fn clamp_and_rate(x: &Inputs) -> (Clamp, Clamp) {
    let three = |k: usize| x.fixed_rows::<3>(k).into_owned();
    (
        Clamp { pose: three(0), reactions: three(REACTIONS), natural: x[NATURAL], friction: x[FRICTION] },
        Clamp { pose: three(MOTION), reactions: three(RATES), natural: 0.0, friction: 0.0 },
    )
}

/// The corrections by given errors, and by these with one of them a step larger.
#[derive(Clone, Debug)]
pub(crate) struct CorrectionDifferences {
    here: Correction,
    /// By the number of the error.
    stepped: Vec<(usize, Correction)>,
}

impl CorrectionDifferences {
    /// With a step of each error that `counts`; none where gains and cross-talk leave fewer than three channels.
    pub fn new(frame: Frame, errors: &Errors, counts: impl Fn(usize) -> bool) -> Option<Self> {
        let stepped = |k: usize| {
            let mut errors = *errors;
            errors[k] += STEP;
            Some((k, Correction::new(frame, &errors)?))
        };
        let stepped = (0..SOURCES).filter(|k| counts(*k)).map(stepped).collect::<Option<_>>()?;
        Some(Self { here: Correction::new(frame, errors)?, stepped })
    }

    /// Whether no error counts.
    pub fn is_exact(&self) -> bool {
        self.stepped.is_empty()
    }

    /// The correction by the errors themselves.
    pub fn here(&self) -> &Correction {
        &self.here
    }

    /// Derivatives of the corrected sample by the errors that count, 0 by others. The place of the clamp is measured in metres: its
    /// derivatives by the length are in lengths of the rod before the error, so that they do not depend on where the frame is.
    pub fn input_derivatives(&self, tau: f64, measured: &LocalEstimate) -> SMatrix<f64, INPUTS, SOURCES> {
        let at = |correction: &Correction| {
            let mut x = inputs(&correction.apply(tau, &measured.clamp, &measured.rate));
            x[0] *= correction.length();
            x[1] *= correction.length();
            x
        };
        let mut by = SMatrix::<f64, INPUTS, SOURCES>::zeros();
        let here = at(&self.here);
        for (k, stepped) in &self.stepped {
            by.set_column(*k, &((at(stepped) - here) / STEP));
        }
        by
    }
}

/// Derivatives of the criteria of a corrected place by the errors; 0 where a criterion is not known, and for those of the zero of the moment
/// where these do not count (`zeros`).
pub(super) fn criteria_derivatives<I: Inverse>(
    rod: &I,
    place: &(Clamp, Clamp),
    by_errors: &SMatrix<f64, INPUTS, SOURCES>,
    zeros: bool,
) -> SMatrix<f64, CRITERIA, SOURCES> {
    // another rod than the uniform one is bent at rest as its model says
    let is_bent = I::UNIFORM && by_errors.row(NATURAL).iter().any(|by| *by != 0.0);
    let mut by_inputs = SMatrix::<f64, CRITERIA, INPUTS>::zeros();
    let [clamp, rate] = [&place.0, &place.1];
    for c in 0..3 {
        by_inputs[(c, REACTIONS + c)] = 1.0;
    }
    let (k, r) = (Criterion::K as usize, &clamp.reactions);
    let first = if zeros || !I::UNIFORM { rod.first(clamp).ok() } else { None };
    if let Some((_, by_reactions)) = rod.criterion(clamp, first.as_ref()) {
        by_inputs.fixed_view_mut::<1, 3>(k, REACTIONS).copy_from(&by_reactions.transpose());
        by_inputs[(k, NATURAL)] = if I::UNIFORM { -2.0 * r.z } else { 0.0 };
        by_inputs[(k, FRICTION)] = -2.0 * r.x.hypot(r.y) * (1.0 + clamp.friction * clamp.friction).powf(-1.5);
    }
    if let Some(first) = first.filter(|_| zeros) {
        let of = |clamp: &Clamp| rod.first(clamp).ok();
        let by = moment_zero_derivatives(clamp, rate, &first, is_bent, of);
        by_inputs.fixed_rows_mut::<3>(Criterion::Length as usize).copy_from(&by);
        if let Some(later) = rod.by_tip(&first, clamp) {
            let of = |clamp: &Clamp| rod.by_tip(&rod.first(clamp).ok()?, clamp);
            let by = moment_zero_derivatives(clamp, rate, &later, is_bent, of);
            by_inputs.fixed_rows_mut::<3>(Criterion::LengthByTip as usize).copy_from(&by);
        }
    }
    // where the clamp turns together with its motion, the reactions and their rates, no criterion changes
    let (v, w) = (&rate.pose, &rate.reactions);
    let turned =
        [(REACTIONS, -r.y), (REACTIONS + 1, r.x), (MOTION, -v.y), (MOTION + 1, v.x), (RATES, -w.y), (RATES + 1, w.x)];
    for c in 3..CRITERIA {
        by_inputs[(c, ANGLE)] = -turned.iter().map(|(k, turn)| by_inputs[(c, *k)] * turn).sum::<f64>();
    }
    by_inputs * by_errors
}

/// Derivatives by the inputs, but for the angle of the clamp, of the arc length of a zero of the moment, and of its speed across the contour
/// and along it; 0 where it vanishes with a step. `of` is the zero of another clamp; by the natural curvature only where that counts.
fn moment_zero_derivatives(
    clamp: &Clamp,
    rate: &Clamp,
    found: &MomentZero,
    is_bent: bool,
    of: impl Fn(&Clamp) -> Option<MomentZero>,
) -> SMatrix<f64, 3, INPUTS> {
    let value = |found: &MomentZero| {
        let [across, along] = found.speeds(&found.velocity(rate));
        Vector3::new(found.s, across, along)
    };
    let mut by = SMatrix::<f64, 3, INPUTS>::zeros();
    let here = value(found);
    let stepped = |k: usize| {
        let mut clamp = *clamp;
        if k == NATURAL {
            clamp.natural += STEP
        } else {
            clamp.reactions[k - REACTIONS] += STEP
        }
        of(&clamp).map_or_else(Vector3::zeros, |found| (value(&found) - here) / STEP)
    };
    for k in (REACTIONS..REACTIONS + 3).chain(is_bent.then_some(NATURAL)) {
        by.set_column(k, &stepped(k));
    }
    // friction turns the contour
    let turn = clamp.alpha_by_friction(found.section.phi);
    by.set_column(FRICTION, &(Vector3::new(0.0, -here[2], here[1]) * turn));
    // the velocity is linear in the rates
    let velocities =
        [Vector2::x(), Vector2::y(), found.by_phi0.xy()].into_iter().enumerate().map(|(c, v)| (MOTION + c, v));
    let of_rates = found.by_reactions.column_iter().enumerate().map(|(c, by)| (RATES + c, by.xy()));
    for (k, velocity) in velocities.chain(of_rates) {
        let [across, along] = found.speeds(&velocity);
        by.set_column(k, &Vector3::new(0.0, across, along));
    }
    by
}

/// Variances of the criteria that errors with this factor of their covariance cause.
pub(super) fn variances(by_errors: &SMatrix<f64, CRITERIA, SOURCES>, factor: &Joint) -> [f64; CRITERIA] {
    let spread = by_errors * factor;
    std::array::from_fn(|c| spread.row(c).norm_squared())
}

/// The covariance of the contact point at a place of phase A or B that errors with this factor of their covariance cause,
/// dimensionless, with `misfit` times that of the noise. The place is corrected. None where there is no contact point.
pub(crate) fn point_covariance<I: Inverse>(
    rod: &I,
    around: &CorrectionDifferences,
    tau: f64,
    measured: &LocalEstimate,
    noise: &Matrix3<f64>,
    label: Label,
    (factor, misfit): (&Joint, f64),
) -> Option<Matrix2<f64>> {
    let (by_errors, by_reactions) = point_derivatives(rod, around, tau, measured, noise, label)?;
    let spread = by_errors * factor;
    let covariance = spread * spread.transpose() + by_reactions * noise * by_reactions.transpose() * misfit;
    covariance.iter().all(|v| v.is_finite()).then_some(covariance)
}

/// Derivatives of the contact point at a place of phase A or B by the errors, and by the reactions, in lengths of the rod before the errors.
/// They are those of errors around 0.
pub(super) fn point_derivatives<I: Inverse>(
    rod: &I,
    around: &CorrectionDifferences,
    tau: f64,
    measured: &LocalEstimate,
    noise: &Matrix3<f64>,
    label: Label,
) -> Option<(SMatrix<f64, 2, SOURCES>, SMatrix<f64, 2, 3>)> {
    let by_errors = around.input_derivatives(tau, measured);
    let here = inputs(&around.here().apply(tau, &measured.clamp, &measured.rate));
    let point = |x: &Inputs| {
        let touch = constrained_contact(rod, &clamp_and_rate(x).0, noise, label).ok()?;
        Some(Vector2::new(touch.x, touch.y))
    };
    let found = point(&here)?;
    // the point moves with the clamp
    let mut by_inputs = SMatrix::<f64, 2, POINT_INPUTS>::identity();
    let is_reaction = |k: usize| (REACTIONS..REACTIONS + 3).contains(&k);
    for k in (ANGLE..POINT_INPUTS).filter(|k| is_reaction(*k) || by_errors.row(*k).iter().any(|by| *by != 0.0)) {
        let mut x = here;
        x[k] += STEP;
        by_inputs.set_column(k, &((point(&x)? - found) / STEP));
    }
    let mut by = by_inputs * by_errors.fixed_rows::<POINT_INPUTS>(0);
    // a longer rod reaches farther
    by[(0, Source::Length as usize)] += found.x - here[0];
    by[(1, Source::Length as usize)] += found.y - here[1];
    Some((by, by_inputs.fixed_columns::<3>(REACTIONS).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::Evidence;
    use rod_core::Uniform;

    #[test]
    fn derivatives_of_the_criteria_are_those_of_differences() {
        let place = |[f0x, f0y, m0z]: [f64; 3], natural: f64, friction: f64| {
            let at = |pose, reactions, natural, friction| Clamp { pose, reactions, natural, friction };
            let (pose, reactions) = (Vector3::new(0.3, -0.4, 1.5), Vector3::new(f0x, f0y, m0z));
            let (motion, rates) = (Vector3::new(-0.9, 0.2, 0.3), Vector3::new(2.0, -3.0, 1.5));
            (at(pose, reactions, natural, friction), at(motion, rates, 0.0, 0.0))
        };
        // the moments of the last vanish twice before the tip
        for (reactions, later) in
            [([-2.3, 0.9, 1.5], false), ([-3.8, 5.4, 3.5], false), ([0.5, -0.4, -0.3], false), ([1.0, 30.0, 0.8], true)]
        {
            for (natural, friction) in [(0.0, 0.0), (0.02, 0.2), (-0.01, -0.3)] {
                let place = place(reactions, natural, friction);
                // one input after the other in place of errors
                let by = criteria_derivatives(&Uniform, &place, &SMatrix::<f64, INPUTS, SOURCES>::identity(), true);
                let here = inputs(&place);
                let again = Evidence::of(&Uniform, &LocalEstimate::exact(place.0, place.1)).again();
                assert_eq!(again, later, "{reactions:?}");
                for k in 0..INPUTS {
                    let at = |step: f64| {
                        let mut x = here;
                        x[k] += step;
                        let (clamp, rate) = clamp_and_rate(&x);
                        let quantities = Evidence::of(&Uniform, &LocalEstimate::exact(clamp, rate)).quantities();
                        SVector::<f64, CRITERIA>::from(quantities.map(|quantity| quantity.value))
                    };
                    let difference = ((at(1e-5) - at(-1e-5)) / 2e-5).map(|by| if by.is_finite() { by } else { 0.0 });
                    let off = (difference - by.column(k)).norm();
                    assert!(off < 1e-5 * (1.0 + difference.norm()), "{reactions:?} {k}: {difference} {}", by.column(k));
                }
            }
        }
    }
}
