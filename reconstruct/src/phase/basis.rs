//! The criterion that decided a label.

use std::fmt;

/// The criterion that decided a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Basis {
    /// The size of the reactions.
    Force,
    /// The phase criterion K (Merker et al. 2020, eq. 20).
    Criterion,
    /// The arc length at which the moment vanishes.
    Length,
    /// The direction in which the reconstructed point moves.
    Tangent,
    /// Kinks and the phase diagram: the phases before and after.
    Diagram,
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Force => "force",
            Self::Criterion => "criterion",
            Self::Length => "length",
            Self::Tangent => "tangent",
            Self::Diagram => "diagram",
        })
    }
}
