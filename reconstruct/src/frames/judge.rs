//! The shapes that explain a frame, and what of it can be relied on.

use super::candidate::Candidate;
use super::choose::{Allowed, Search};
use super::observed::Observed;
use super::result::FrameContact;
use super::verdict::{FamilyMember, FrameVerdict};
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

/// Standard deviation of the place of a contact (L) from which on it is not told.
const VAGUE_PLACE: f64 = 0.1;
/// Standard deviation of a force, as a share of it, from which on it is not told.
const VAGUE_FORCE: f64 = 0.5;

/// The verdict on the best candidate with its contacts, and those of the shapes that explain the frame too, of a rod of `length` (m).
///
/// `is_placed` says whether anything tells where along the rod the points are: a uniform rod looks the same everywhere.
pub(super) fn verdict<'a>(
    best: &Candidate,
    is_placed: bool,
    contacts: &'a [FrameContact],
    of_rivals: impl Iterator<Item = &'a FrameContact>,
    length: f64,
) -> FrameVerdict {
    if !best.explains() {
        return FrameVerdict::NotExplained;
    }
    if contacts.is_empty() {
        return FrameVerdict::Free;
    }
    if best.covariance.is_none() || !is_placed {
        return FrameVerdict::Family;
    }
    let place = |contact: &FrameContact| contact.sigmas()[0] / length;
    // what is anywhere within three tenths of the length is anywhere
    let is_anywhere = |contact: &FrameContact| place(contact).is_nan() || place(contact) > 3.0 * VAGUE_PLACE;
    let is_vague = |contact: &FrameContact| {
        place(contact) > VAGUE_PLACE || contact.force == 0.0 || contact.sigma_force > VAGUE_FORCE * contact.force
    };
    let mut of_rivals = of_rivals.peekable();
    let has_rivals = of_rivals.peek().is_some();
    if contacts.iter().chain(of_rivals).any(is_anywhere) {
        return FrameVerdict::Family;
    }
    if has_rivals {
        return FrameVerdict::Several;
    }
    // as many unknowns as numbers: nothing checks them
    if best.freedom <= 0 || contacts.iter().any(is_vague) { FrameVerdict::Uncertain } else { FrameVerdict::Determined }
}
