//! The contact phases that reactions distinguish.

use core::fmt;

/// The contact phase of a sample, as far as the reactions determine it: they do not distinguish two contacts from more.
///
/// ```
/// use rod_reconstruct::Label;
/// assert_eq!(Label::BA.to_string(), "BA");
/// assert!(Label::BA.several() && Label::BA.tip() && !Label::B.several());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Label {
    /// The rod touches nothing.
    #[cfg_attr(feature = "serde", serde(rename = "free"))]
    Free,
    /// One contact, at the tip.
    A,
    /// One contact, tangential (a smooth stretch, an edge or a vertex).
    B,
    /// Several contacts, the last one at the tip (BA, BBA, ...).
    BA,
    /// Several contacts, the last one tangential (BB, BBB, ...).
    BB,
}

impl Label {
    /// All labels, in the order of their numbers.
    pub const ALL: [Self; 5] = [Self::Free, Self::A, Self::B, Self::BA, Self::BB];

    /// Whether the rod is held by more than one contact.
    pub fn several(self) -> bool {
        matches!(self, Self::BA | Self::BB)
    }

    /// Whether its tip is in contact.
    pub fn tip(self) -> bool {
        matches!(self, Self::A | Self::BA)
    }

    /// The label of a rod with this many contacts, the last one at its tip or not.
    pub fn of(contacts: usize, tip: bool) -> Self {
        match (contacts, tip) {
            (0, _) => Self::Free,
            (1, true) => Self::A,
            (1, false) => Self::B,
            (_, true) => Self::BA,
            (_, false) => Self::BB,
        }
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Free => "free",
            Self::A => "A",
            Self::B => "B",
            Self::BA => "BA",
            Self::BB => "BB",
        })
    }
}
