//! What a frame cannot tell.

use super::candidate::Candidate;
use std::fmt;

/// Standard deviation of the place of a contact (L) from which on it is not told.
const VAGUE_PLACE: f64 = 0.1;
/// Standard deviation of a force, as a share of it, from which on it is not told.
const VAGUE_FORCE: f64 = 0.5;

/// What a frame tells of the forces on the rod, from the information matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameVerdict {
    /// No force beyond the noise.
    Free,
    /// Contacts, forces and reactions are determined.
    Told,
    /// A contact is there, but its place and its force are known roughly only (standard deviations of more than a tenth of the length, or of
    /// half of the force), or there are as many unknowns as numbers, so that nothing checks them: what they do together, the moment at the base, may be known well.
    Rough,
    /// Place and force are not told apart at all: a whole family of them explains the frame.
    Family,
    /// More than one set of contacts explains the frame: the others are rivals.
    Several,
    /// No shape with the contacts that are allowed explains the frame.
    NotExplained,
}

impl fmt::Display for FrameVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Free => "free",
            Self::Told => "told",
            Self::Rough => "rough",
            Self::Family => "family",
            Self::Several => "several",
            Self::NotExplained => "not explained",
        })
    }
}

/// One member of a family that explains a frame: the force that a contact at this place has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FamilyMember {
    /// Arc length of the contact, m.
    pub s: f64,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Force, N.
    pub force: f64,
    /// Chi squared of the frame.
    pub chi_squared: f64,
}

/// The verdict on the best candidate; `sigmas` are those of arc length (L) and of force (as a share) of each contact, and the others those of
/// the contacts that explain the frame too.
///
/// `is_placed` says whether anything tells where along the rod the points are: a uniform rod looks the same everywhere.
pub(super) fn verdict(
    best: &Candidate,
    is_placed: bool,
    sigmas: impl Iterator<Item = (f64, f64)>,
    of_rivals: impl Iterator<Item = (f64, f64)>,
) -> FrameVerdict {
    if !best.explains() {
        return FrameVerdict::NotExplained;
    }
    if best.covariance.is_none() || (!is_placed && !best.shape.contacts.is_empty()) {
        return FrameVerdict::Family;
    }
    if best.shape.contacts.is_empty() {
        return FrameVerdict::Free;
    }
    // what is anywhere within three tenths of the length is anywhere
    let is_anywhere = |place: f64| place.is_nan() || place > 3.0 * VAGUE_PLACE;
    let (mut is_rough, mut is_family) = (false, false);
    for (place, force) in sigmas {
        // as many unknowns as numbers: nothing checks them
        is_rough |= place > VAGUE_PLACE || force > VAGUE_FORCE || best.freedom <= 0;
        is_family |= is_anywhere(place);
    }
    let mut has_rivals = false;
    for (place, _) in of_rivals {
        has_rivals = true;
        is_family |= is_anywhere(place);
    }
    match (is_family, has_rivals, is_rough) {
        (true, ..) => FrameVerdict::Family,
        (_, true, _) => FrameVerdict::Several,
        (.., true) => FrameVerdict::Rough,
        _ => FrameVerdict::Told,
    }
}
