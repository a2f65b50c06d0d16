//! What depends on the ends of the rod that are visible: its apparent shortening, and the forces if its base is hidden.

use super::candidate::Candidate;
use super::choose::{Allowed, choose};
use super::observation::{Axis, Measurand};
use super::observed::Observed;
use super::problem::reactions;
use crate::numeric::CHANCE;
use rod_core::{RodModel, Units};

/// The same frame if the base of the rod is hidden: the length that no point shows lies before the first point, and the last point is the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenBase {
    /// The length of the rod that no point shows, m.
    pub length: f64,
    /// Force of the contact nearest to the base, N.
    pub force: f64,
    /// Moment of the clamp on the rod at the hidden base, N m.
    pub m0z: f64,
}

/// By how much a rod of which both ends are seen looks too short (share of its length), with its standard deviation.
pub(super) fn shortening(best: &Candidate, observed: &Observed) -> Option<(f64, f64)> {
    let ([true, true], [first, .., last]) = (observed.ends, &observed.dots[..]) else { return None };
    Some((1.0 - best.feet.last()?, first.sigma.hypot(last.sigma)))
}

/// The forces if the hidden part of the rod is at its base. The lever from the first point to the clamp, and with a taper the stiffness at each
/// point, depend on it. None if the points or the channels tell where the base is: the rod is seen to its tip, its base is measured, nothing
/// touches it, or the frame contradicts a hidden base.
pub(super) fn hidden_base<M: RodModel>(
    model: &M,
    best: &Candidate,
    observed: &Observed,
    allowed: Allowed,
    units: &Units,
) -> Option<HiddenBase> {
    let ([true, false], [first, .., last]) = (observed.ends, &observed.dots[..]) else { return None };
    let places = [Axis::X, Axis::Y].map(|axis| [Measurand::Base(axis), Measurand::Support(axis)]);
    let is_measured = places.as_flattened().iter().any(|place| observed.channel(*place).is_some());
    let hidden = 1.0 - best.feet.last()?;
    let is_noise = hidden <= CHANCE * first.sigma.hypot(last.sigma);
    if is_measured || is_noise || best.shape.contacts.is_empty() || !best.explains() {
        return None;
    }
    let mut other = Observed { ends: [false, true], ..observed.clone() };
    other.dots.first_mut()?.s = None;
    other.dots.last_mut()?.s = Some(1.0);
    let moved = choose(model, &other, allowed)?.best;
    let [a, b] = moved.shape.contacts.last().filter(|_| moved.explains())?.force.ab;
    let ([_, _, moment], _) = reactions(&moved.shape);
    Some(HiddenBase { length: hidden * units.length, force: a.hypot(b) * units.force, m0z: moment * units.moment })
}
