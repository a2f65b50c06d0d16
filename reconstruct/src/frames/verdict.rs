//! What a frame cannot tell.

use std::fmt;

/// What a frame tells of the forces on the rod, from the information matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameVerdict {
    /// No force beyond the noise.
    Free,
    /// Contacts, forces and reactions are determined.
    Told,
    /// A contact is there, but its place and its force are known roughly only (standard deviations of more than a tenth of the length, or of
    /// half of the force), or their standard deviations are those of a curved valley of chi squared and too small, or there are as many unknowns as
    /// numbers, so that nothing checks them: what they do together, the moment at the base, may be known well.
    Rough,
    /// Place and force are not told apart at all: a whole family of them explains the frame.
    Family,
    /// More than one set of contacts explains the frame: the others are rivals.
    Several,
    /// No shape with the contacts that are allowed explains the frame.
    NotExplained,
}

impl FrameVerdict {
    /// Whether a frame has contacts of its own: not one of a family, nor those of a shape that does not explain it.
    pub fn has_contacts_of_its_own(self) -> bool {
        !matches!(self, Self::Family | Self::NotExplained)
    }
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
