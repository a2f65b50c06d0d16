//! Straight scans, by distance and angle.

use crate::PlanError;
use rod_contact::{ClampPath, ContactError};
use rod_core::Pose;

/// Way (rod lengths) of the clamp beyond the object on either side: there even a rod that lies along the path is free.
const BEYOND: f64 = 1.05;

/// To which side of the rod, seen from its clamp, the clamp moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pass {
    /// To the left, as in Merker et al. (2020).
    Left,
    /// To the right.
    Right,
}

impl Pass {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];
}

/// `left` or `right`.
impl std::fmt::Display for Pass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

/// A scan on a straight line across the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightScan {
    /// Distance (m) of the line from the object's nearest place, along the rod: the q of Merker et al. (2020).
    pub distance: f64,
    /// Direction of the rod at its clamp, rad: pi / 2 points up.
    pub angle: f64,
    /// To which side the clamp moves.
    pub pass: Pass,
}

impl StraightScan {
    /// Whether it can be, for a rod of this length (m).
    pub(crate) fn check(self, length: f64) -> Result<(), PlanError> {
        let Self { distance: value, angle, .. } = self;
        match (value > 0.0 && value < length, angle.is_finite()) {
            (false, _) => Err(PlanError::Distance { value, length }),
            (_, false) => Err(PlanError::Angle { value: angle }),
            _ => Ok(()),
        }
    }

    /// The path past an object whose nearest place along the rod's direction is `nearest` (m, from the origin), and which spans `across`
    /// (m, from the origin to the left of the rod), for a rod of this length (m).
    pub(crate) fn path(self, nearest: f64, across: (f64, f64), length: f64) -> Result<ClampPath, ContactError> {
        let (sin, cos) = self.angle.sin_cos();
        let along = nearest - self.distance;
        let clamp = |left: f64| Pose { x: along * cos - left * sin, y: along * sin + left * cos, phi: self.angle };
        let ends = [across.0 - BEYOND * length, across.1 + BEYOND * length].map(clamp);
        match self.pass {
            Pass::Left => ClampPath::new(ends[0], ends[1]),
            Pass::Right => ClampPath::new(ends[1], ends[0]),
        }
    }
}
