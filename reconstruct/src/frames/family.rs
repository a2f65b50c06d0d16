//! What fits where place and force of a contact are not told apart.

use super::choose::{Allowed, Search};
use super::observed::Observed;
use super::verdict::FamilyMember;
use rod_core::{RodModel, Units};

/// Number of places along the rod that are tried.
const PLACES: usize = 20;

/// The force at many places along the rod, each with the chi squared of the best shape whose contact is there.
pub(super) fn family<M: RodModel>(
    model: &M,
    observed: &Observed,
    units: &Units,
    allowed: Allowed,
) -> Vec<FamilyMember> {
    let search = Search::of(model, observed, allowed);
    let places = (1..=PLACES).map(|k| k as f64 / PLACES as f64);
    let members = places.filter_map(|s| {
        let held = search.held_at(s)?;
        let contact = held.shape.contacts.first()?;
        let [a, b] = contact.force.ab;
        Some(FamilyMember {
            s: s * units.length,
            x: contact.node.cut.x * units.length,
            y: contact.node.cut.y * units.length,
            force: a.hypot(b) * units.force,
            chi_squared: held.chi_squared,
        })
    });
    members.collect()
}
