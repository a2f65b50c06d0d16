//! The answer to one sample.

use crate::phase::{Basis, Label, PlaceNumber};
use crate::point::{NoContact, Touch};
use crate::scan::Fault;
use crate::two_contacts::Unresolved;
use rod_core::Units;

/// Why there is no contact point.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The rod touches nothing.
    #[error("the rod is free")]
    Free,
    /// The sample cannot be used.
    #[error("{0}")]
    Fault(#[from] Fault),
    /// No single contact fits, though the label says there is one.
    #[error("{0}")]
    NoContact(#[from] NoContact),
    /// A criterion that holds in this phase does not: the phase, or the model, is wrong here.
    #[error("the {criterion} criterion contradicts the phase by {z:.0} standard deviations")]
    Contradicted {
        /// Which.
        criterion: Basis,
        /// By how many standard deviations.
        z: f64,
    },
    /// How far errors that all samples share displace the point is not known at any place of this run.
    #[error("the systematic error of the point is not known here")]
    Unshared,
    /// The point is too uncertain.
    #[error("the standard deviation of the point is {sigma:.1e} m, too large")]
    TooNoisy {
        /// Standard deviation across the contour, m; along it, if that is the one that is too large.
        sigma: f64,
    },
    /// The contour has a contact where nothing else tells of the contour.
    #[error("nothing tells where on the contour this contact is")]
    Untouched,
    /// The sample has several contacts, which are resolved from a whole scan only.
    #[error("several contacts, which are resolved from the whole scan only")]
    Live,
    /// This one of several contacts is not resolved.
    #[error("several contacts: {0}")]
    Several(#[from] Unresolved),
}

/// The answer to one sample, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The phase.
    pub label: Label,
    /// Probability of the label, 0 to 1. Where nothing tells BA from BB, as for a rod that is not uniform, that of several contacts.
    pub probability: f64,
    /// The contact, or the first of several.
    pub touch: Result<Touch, Reason>,
    /// The second of several; none where the label is of a single contact or none.
    pub second: Option<Result<Touch, Reason>>,
    /// The place whose evidence decided.
    pub(super) place: PlaceNumber,
}

impl Reading {
    /// A sample of this label that has no contact point.
    pub(super) fn without(label: Label, reason: Reason) -> Self {
        Self { label, probability: 0.0, touch: Err(reason), second: None, place: PlaceNumber::NONE }
    }

    /// A sample of which a model gives the contacts, from the clamp to the tip.
    #[cfg(feature = "contact")]
    pub(crate) fn of_model(label: Label, probability: f64, touches: &[Result<Touch, Reason>]) -> Self {
        let touch = touches.first().copied().unwrap_or(Err(Reason::Free));
        let second = touches.get(1).copied();
        Self { label, probability, touch, second, place: PlaceNumber::NONE }
    }
}

/// The point in SI units, if it is known well enough. Of clean samples only the noise counts: a contact that has just begun is exact,
/// though a bias that nobody knows of might move it anywhere.
pub(super) fn sure(touch: Touch, units: Units, largest_sigma: f64, clean: bool) -> Result<Touch, Reason> {
    let sigma = touch.sigma_normal();
    let sigma = if clean { (sigma * sigma - touch.sigma_systematic().powi(2)).max(0.0).sqrt() } else { sigma };
    if sigma <= largest_sigma {
        Ok(touch.in_units(units))
    } else {
        Err(Reason::TooNoisy { sigma: sigma * units.length })
    }
}
