//! What happens along a sweep between two phases.

use crate::phase::Phase;
use crate::state::State;
use rod_core::Pose;
use std::fmt;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum EventKind {
    /// The free rod meets the contour.
    FirstContact,
    /// A rod in contact meets the contour at one more place, or its last contact, at an inflection of the contour,
    /// parts into two.
    Touch,
    /// A contact lets go, or two run together at an inflection of the contour.
    Release,
    /// The tip lies down on the contour: A -> B.
    TipToTangent,
    /// A tangential contact reaches the tip: B -> A.
    TangentToTip,
    /// A contact runs over the border of a piece: onto the next one, a corner or a notch.
    Piece,
    /// The tip slips over a convex corner, by less than 0.05 lengths of the rod, and rests on the piece beyond.
    SlipOver,
    /// A contact that slips, or a rod with friction whose clamp turns back, comes to rest on the contour: from there on it sticks or rolls.
    Stick,
    /// A contact that sticks or rolls has all the force along the contour that friction can bear, and begins to slip.
    Slip,
    /// The equilibrium ends and the rod jumps to another one.
    Snap,
    /// The equilibrium ends and the rod jumps free.
    SnapOff,
}

impl fmt::Display for EventKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::FirstContact => "first-contact",
            Self::Touch => "touch",
            Self::Release => "release",
            Self::TipToTangent => "tip-to-tangent",
            Self::TangentToTip => "tangent-to-tip",
            Self::Piece => "piece",
            Self::SlipOver => "slip-over",
            Self::Stick => "stick",
            Self::Slip => "slip",
            Self::Snap => "snap",
            Self::SnapOff => "snap-off",
        })
    }
}

/// A transition, located on the path to 1e-10 of the rod's length or better.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// The last state before. At a snap or slip it is the one where the equilibrium ended; otherwise it equals `after`
    /// up to the contact of zero force that comes or goes.
    pub before: State,
    /// The first state after, at the same pose of the clamp, or at most 0.05 lengths of the rod further along the path:
    /// after a snap whose new branch starts only beyond the fold, where it starts, and at an inflection of the contour,
    /// where the two contacts are (were) 0.01 lengths of the rod apart. Poses to report in between have no state.
    pub after: State,
    /// Energy (J) lost since the sweep began by friction and jumps, that of this event included; none without friction
    /// ([`Sweep::dissipated`](crate::Sweep::dissipated)).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub dissipated: Option<f64>,
}

impl Event {
    /// Where the clamp was.
    pub fn pose(&self) -> Pose {
        self.before.pose
    }

    /// On which leg of the path, from 0.
    pub fn leg(&self) -> usize {
        self.before.leg
    }

    /// Phase before.
    pub fn from(&self) -> Phase {
        self.before.phase()
    }

    /// Phase after.
    pub fn to(&self) -> Phase {
        self.after.phase()
    }
}
