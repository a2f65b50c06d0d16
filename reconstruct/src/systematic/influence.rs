//! How the criteria of a place, and the contact point there, depend on the errors that all samples share.

use super::correction::{Correction, Frame};
use super::source::{Errors, Joint, SOURCES, Source};
use crate::phase::{CRITERIA, Evidence, Label, constrained};
use crate::point::Clamp;
use crate::scan::Estimate;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector};
use rod_core::Uniform;

/// Pose, reactions, natural curvature, friction, and rates of pose and reactions.
const INPUTS: usize = 14;
/// The first eight of them determine the contact point.
pub(super) const OF_POINT: usize = 8;
/// Step of differences by inputs of size 1: the error of a central difference is some 1e-10 relative, far below that of any budget.
const STEP: f64 = 1e-5;

type Inputs = SVector<f64, INPUTS>;

fn inputs((clamp, rate): &(Clamp, Clamp)) -> Inputs {
    let (p, r, v, w) = (&clamp.pose, &clamp.reactions, &rate.pose, &rate.reactions);
    let (n, f) = (clamp.natural, clamp.friction);
    Inputs::from([p.x, p.y, p.z, r.x, r.y, r.z, n, f, v.x, v.y, v.z, w.x, w.y, w.z])
}

fn of_inputs(x: &Inputs) -> (Clamp, Clamp) {
    let three = |k: usize| x.fixed_rows::<3>(k).into_owned();
    (
        Clamp { pose: three(0), reactions: three(3), natural: x[6], friction: x[7] },
        Clamp { pose: three(8), reactions: three(11), natural: 0.0, friction: 0.0 },
    )
}

/// Derivatives of the corrected sample by the errors. The place of the clamp is measured in metres: its derivatives by the length are in
/// lengths of the rod before the error, so that they do not depend on where the frame is.
pub(super) fn of_inputs_by_errors(
    frame: Frame,
    errors: &Errors,
    tau: f64,
    measured: &Estimate,
) -> Option<SMatrix<f64, INPUTS, SOURCES>> {
    let mut by = SMatrix::<f64, INPUTS, SOURCES>::zeros();
    for k in 0..SOURCES {
        let at = |step: f64| {
            let mut errors = *errors;
            errors[k] += step;
            let correction = Correction::new(frame, &errors)?;
            let mut x = inputs(&correction.apply(tau, &measured.clamp, &measured.rate));
            x[0] *= correction.length();
            x[1] *= correction.length();
            Some(x)
        };
        by.set_column(k, &((at(STEP)? - at(-STEP)?) / (2.0 * STEP)));
    }
    Some(by)
}

/// Derivatives of the criteria of a corrected place by the errors; 0 where a criterion is not known.
pub(super) fn of_criteria(
    place: &(Clamp, Clamp),
    by_errors: &SMatrix<f64, INPUTS, SOURCES>,
) -> SMatrix<f64, CRITERIA, SOURCES> {
    let here = inputs(place);
    let mut by_inputs = SMatrix::<f64, CRITERIA, INPUTS>::zeros();
    // the place in the plane changes no criterion
    for k in 2..INPUTS {
        let at = |step: f64| {
            let mut x = here;
            x[k] += step;
            let (clamp, rate) = of_inputs(&x);
            SVector::<f64, CRITERIA>::from(Evidence::of(&Uniform, &Estimate::exact(clamp, rate)).values())
        };
        let column = (at(STEP) - at(-STEP)) / (2.0 * STEP);
        by_inputs.set_column(k, &column.map(|v| if v.is_finite() { v } else { 0.0 }));
    }
    by_inputs * by_errors
}

/// Variances of the criteria that errors with this factor of their covariance cause.
pub(super) fn variances(by_errors: &SMatrix<f64, CRITERIA, SOURCES>, factor: &Joint) -> [f64; CRITERIA] {
    let spread = by_errors * factor;
    std::array::from_fn(|c| spread.row(c).norm_squared())
}

/// The covariance of the contact point at a place of phase A or B that errors with this factor of their covariance cause,
/// dimensionless, with `misfit` times that of the noise. The place is corrected. None where there is no contact point.
pub(crate) fn of_point(
    frame: Frame,
    tau: f64,
    measured: &Estimate,
    noise: &Matrix3<f64>,
    label: Label,
    factor: &Joint,
    misfit: f64,
) -> Option<Matrix2<f64>> {
    let (by_errors, by_reactions) = point_by_errors(frame, tau, measured, noise, label)?;
    let spread = by_errors * factor;
    let covariance = spread * spread.transpose() + by_reactions * noise * by_reactions.transpose() * misfit;
    covariance.iter().all(|v| v.is_finite()).then_some(covariance)
}

/// Derivatives of the contact point at a place of phase A or B by the errors, and by the reactions, in lengths of the rod before the errors.
pub(super) fn point_by_errors(
    frame: Frame,
    tau: f64,
    measured: &Estimate,
    noise: &Matrix3<f64>,
    label: Label,
) -> Option<(SMatrix<f64, 2, SOURCES>, SMatrix<f64, 2, 3>)> {
    let none = Errors::zeros();
    let by_errors = of_inputs_by_errors(frame, &none, tau, measured)?;
    let here = inputs(&Correction::new(frame, &none)?.apply(tau, &measured.clamp, &measured.rate));
    let mut by_inputs = SMatrix::<f64, 2, OF_POINT>::zeros();
    for k in 0..OF_POINT {
        let at = |step: f64| {
            let mut x = here;
            x[k] += step;
            let touch = constrained(&Uniform, &of_inputs(&x).0, noise, label).ok()?;
            Some(SVector::<f64, 2>::new(touch.x, touch.y))
        };
        by_inputs.set_column(k, &((at(STEP)? - at(-STEP)?) / (2.0 * STEP)));
    }
    let mut by = by_inputs * by_errors.fixed_rows::<OF_POINT>(0);
    // a longer rod reaches farther
    let touch = constrained(&Uniform, &of_inputs(&here).0, noise, label).ok()?;
    by[(0, Source::Length as usize)] += touch.x - here[0];
    by[(1, Source::Length as usize)] += touch.y - here[1];
    Some((by, by_inputs.fixed_columns::<3>(3).into_owned()))
}
