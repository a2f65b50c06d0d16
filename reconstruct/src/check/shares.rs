//! The samples that a single contact explains.

use super::bins::ReactionBin;
use crate::point::{NoContact, Touch, single_with_friction};
use rod_core::{Reactions, Rod};

/// Error of the rod's length that is allowed beyond the tip, relative, and of the phase criterion above 0, relative to m0z^2.
/// Smaller: a rod whose length or stiffness is a little wrong leaves samples unexplained.
const SLACK: f64 = 0.02;

/// Shares of the scan in contact, by whether a single contact explains the samples. They add up to 1 unless the rod is always free.
/// Several contacts are mostly explained by a single one at another place, and hardly count among the others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// A single contact on the rod explains them.
    pub explained: f64,
    /// The contact would be beyond the tip.
    pub beyond_tip: f64,
    /// The contact would have to pull.
    pub pulling: f64,
    /// The moment vanishes nowhere.
    pub no_moment_zero: f64,
}

impl Shares {
    pub(super) fn of(rod: &Rod, bins: &[ReactionBin]) -> Self {
        let one = 1.0 / bins.len() as f64;
        let mut shares = Self::default();
        for bin in bins {
            match contact(rod, bin, bin.reactions) {
                Ok(_) => shares.explained += one,
                Err(NoContact::BeyondTip(_)) => shares.beyond_tip += one,
                Err(NoContact::Pulling(_)) => shares.pulling += one,
                Err(_) => shares.no_moment_zero += one,
            }
        }
        shares
    }
}

/// The single contact of a bin with these reactions, if a rod of about this length and stiffness has one.
pub(super) fn contact(rod: &Rod, bin: &ReactionBin, reactions: Reactions) -> Result<Touch, NoContact> {
    match single_with_friction(rod, bin.pose, reactions, &bin.covariance, bin.friction) {
        Err(NoContact::BeyondTip(touch)) if touch.s <= (1.0 + SLACK) * rod.length() => Ok(touch),
        Err(NoContact::Pulling(touch)) => {
            let stiffness = rod.bending_stiffness();
            let rubbing = reactions.f0x.hypot(reactions.f0y) * bin.friction / bin.friction.hypot(1.0);
            let excess = reactions.phase_criterion(bin.pose.phi, stiffness) - 2.0 * stiffness * rubbing;
            if excess <= SLACK * bin.square { Ok(touch) } else { Err(NoContact::Pulling(touch)) }
        }
        other => other,
    }
}
