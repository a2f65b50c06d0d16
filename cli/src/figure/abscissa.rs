//! What a scan is plotted against.

use vibrissa::{ClampPath, Pose};

/// The coordinate of the clamp that changes most along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Abscissa {
    X,
    Y,
    Angle,
}

impl Abscissa {
    pub fn of(path: &ClampPath) -> Self {
        let rate = path.rate();
        match (path.turns_only(), rate.x.abs() >= rate.y.abs()) {
            (true, _) => Self::Angle,
            (false, true) => Self::X,
            (false, false) => Self::Y,
        }
    }

    /// Its value: mm, or degrees.
    pub fn value(self, pose: Pose) -> f64 {
        match self {
            Self::X => 1e3 * pose.x,
            Self::Y => 1e3 * pose.y,
            Self::Angle => pose.phi.to_degrees(),
        }
    }

    /// What the axis says, with the direction of the scan.
    pub fn label(self, path: &ClampPath) -> String {
        let grows = self.value(path.at(path.length())) > self.value(path.at(0.0));
        let name = match self {
            Self::X => "clamp position x_{0} in mm",
            Self::Y => "clamp position y_{0} in mm",
            Self::Angle => "clamp angle φ_{0} in degrees",
        };
        if grows { format!("{name} (scan →)") } else { format!("{name} (← scan)") }
    }
}
