//! Whether the two contacts slide as their friction asks for.
//!
//! The friction of a contact that slides is known, and that of one that sticks, or on which the rod rolls, is not: then one condition is
//! missing. A contact sticks where the matter of the rod stands still there.

use super::conditions::two_moving;
use super::part::{INSTANTS, Local, Part, place};
use super::unknowns::Unknown;
use crate::point::{Clamp, Inverse};
use nalgebra::{DVector, Vector3};

/// Speed along the rod per way of the clamp, below which matter may stand still: the error of series at their ends. Larger: contacts that
/// slide slowly are given up.
const SLOW: f64 = 1e-3;
/// Standard deviations by which the first contact must slide. Larger: more contacts are given up in noise; smaller: a contact that sticks
/// passes for one that slides.
const SIGMAS: f64 = 3.0;

/// Whether both contacts slide against friction along a part, on the mean: between kinks a contact slides or sticks all the way. Always
/// without friction.
pub(super) fn slides<I: Inverse>(rod: &I, part: &Part, x: &DVector<f64>) -> bool {
    if part.series.friction == 0.0 {
        return true;
    }
    let against = -part.series.friction.signum();
    let speeds = (0..INSTANTS).map(|k| along(rod, &part.local(x, place(k))));
    let sum = speeds.fold([0.0; 2], |sum, two| [0, 1].map(|i| sum[i] + against * two[i]));
    let [first, second] = sum.map(|sum| sum / INSTANTS as f64);
    first > SLOW + SIGMAS * sigma_of_first(rod, part, &part.local(x, 0.0)) && second > SLOW
}

/// The speeds of the rod's matter along the rod at both contacts, per way of the clamp.
fn along<I: Inverse>(rod: &I, local: &Local) -> [f64; 2] {
    let two = two_moving(rod, local);
    // contacts move along the rod besides
    [(&two.first, Unknown::S1), (&two.second, Unknown::S2)].map(|(section, s)| {
        let (sin, cos) = section.phi.value.sin_cos();
        cos * section.x.derivatives[0] + sin * section.y.derivatives[0] - local.rates[s]
    })
}

/// Standard deviation of the first one's mean speed by the noise of the rates: the mean of a rate is the difference of the values at both
/// ends, to which all odd polynomials contribute 1.
fn sigma_of_first<I: Inverse>(rod: &I, part: &Part, local: &Local) -> f64 {
    let reactions = Vector3::from(Unknown::REACTIONS.map(|unknown| local.values[unknown]));
    let Local { natural, friction, .. } = *local;
    let clamp = Clamp { pose: local.pose[0], reactions, natural, friction };
    let (section, gradient) = rod.gradient_at(&clamp, local.values[Unknown::S1]);
    let (sin, cos) = section.phi.sin_cos();
    let series = &part.series;
    let mean = DVector::from_fn(series.terms(), |j, _| if j % 2 == 1 { 1.0 / series.interval.half } else { 0.0 });
    let spread = mean.dot(&(&series.inverse * &mean));
    let by = |c: usize| cos * gradient.by_reactions[(0, c)] + sin * gradient.by_reactions[(1, c)];
    (0..3).map(|c| by(c).powi(2) * series.variance[c] * spread).sum::<f64>().sqrt()
}
