//! Whether the two contacts slide as their friction asks for.
//!
//! The friction of a contact that slides is known, and that of one that sticks, or on which the rod rolls, is not: then one condition is
//! missing. A contact sticks where the matter of the rod stands still there.

use super::conditions::two;
use super::part::{Local, Part};
use super::unknowns::{Gradient, Unknown, Unknowns};
use crate::point::Clamp;
use nalgebra::Vector3;
use rod_core::{Dual, Section};

/// Speed along the rod per way of the clamp, below which matter may stand still: the error of series at their ends. Larger: contacts that
/// slide slowly are given up.
const SLOW: f64 = 1e-3;
/// Standard deviations by which the first contact must slide. Larger: more contacts are given up in noise; smaller: a contact that sticks
/// passes for one that slides.
const SIGMAS: f64 = 3.0;

/// Whether both contacts slide against friction of this sign; always without friction.
pub(super) fn slides(part: &Part, local: &Local) -> bool {
    if local.friction == 0.0 {
        return true;
    }
    // the one derivative is the rate along the scan
    let inputs = Unknowns::from_fn(|u| Dual::<f64, 1> { value: local.values[u], derivatives: [local.rates[u]] });
    let pose = std::array::from_fn(|i| Dual { value: local.pose[0][i], derivatives: [local.pose[1][i]] });
    let two = two(pose, Dual::constant(local.natural), Dual::constant(local.friction), &inputs);
    // contacts move along the rod besides
    let along = |section: &Section<Dual<f64, 1>>, s: Unknown| {
        let (sin, cos) = section.phi.value.sin_cos();
        cos * section.x.derivatives[0] + sin * section.y.derivatives[0] - local.rates[s]
    };
    let against = -local.friction.signum();
    let first = against * along(&two.first, Unknown::S1) - SIGMAS * sigma_of_first(part, local);
    first > SLOW && against * along(&two.second, Unknown::S2) > SLOW
}

/// Standard deviation of the first one's speed by the noise of the rates.
fn sigma_of_first(part: &Part, local: &Local) -> f64 {
    let reactions = Vector3::from(Unknown::REACTIONS.map(|unknown| local.values[unknown]));
    let Local { natural, friction, .. } = *local;
    let clamp = Clamp { pose: local.pose[0], reactions, natural, friction };
    let (section, gradient) = clamp.gradient_at(local.values[Unknown::S1]);
    let (sin, cos) = section.phi.sin_cos();
    let mut by_rate = Unknowns::ZERO;
    for (c, unknown) in Unknown::REACTIONS.into_iter().enumerate() {
        by_rate[unknown] = cos * gradient.by_reactions[(0, c)] + sin * gradient.by_reactions[(1, c)];
    }
    part.noise(local, &Gradient { by_value: Unknowns::ZERO, by_rate }).sqrt()
}
