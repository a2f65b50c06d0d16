//! What a frame determines.

use std::fmt;

/// Whether a frame determines the forces on the rod, from the information matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameVerdict {
    /// No force beyond the noise.
    Free,
    /// Contacts, forces and reactions are determined.
    Determined,
    /// There is a contact, but its place or its force is uncertain: a standard deviation exceeds a tenth of the length or half of the force; or chi
    /// squared is not quadratic within one standard deviation, which is then too small; or there are as many unknowns as numbers, so that no residual
    /// checks them. The moment at the base may be known well all the same.
    Uncertain,
    /// Place and force are not determined separately: a one-parameter family of them explains the frame.
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
            Self::Determined => "determined",
            Self::Uncertain => "uncertain",
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
