//! What a scan is plotted against.

use rod_files::Scene;
use vibrissa::{ClampPath, Pose, State};

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

/// What the states of a sweep are plotted against: a coordinate of the clamp; of several legs, which may go to and fro, the way so far.
pub(super) enum Course<'a> {
    Coordinate(&'a ClampPath, Abscissa),
    Way(&'a Scene),
}

impl<'a> Course<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        if scene.legs.is_empty() { Self::Coordinate(&scene.path, Abscissa::of(&scene.path)) } else { Self::Way(scene) }
    }

    /// Its value at a state: mm, or degrees.
    pub fn value(&self, state: &State) -> f64 {
        match self {
            Self::Coordinate(_, abscissa) => abscissa.value(state.pose),
            Self::Way(scene) => 1e3 * scene.way_in_m(state.leg, state.pose),
        }
    }

    /// Its values at the ends of the path and of its legs.
    pub fn ends(&self) -> Vec<f64> {
        match self {
            Self::Coordinate(path, abscissa) => [0.0, path.length()].map(|way| abscissa.value(path.at(way))).to_vec(),
            Self::Way(scene) => {
                std::iter::once(0.0).chain(scene.ends_of_legs().into_iter().map(|way| 1e3 * way)).collect()
            }
        }
    }

    /// What the axis says.
    pub fn label(&self) -> String {
        match self {
            Self::Coordinate(path, abscissa) => abscissa.label(path),
            Self::Way(scene) => {
                let turns = scene.path.turns_only() || scene.legs.iter().any(|leg| leg.path.turns_only());
                format!("way of the clamp in mm{}", if turns { " (turning: of the tip)" } else { "" })
            }
        }
    }
}
