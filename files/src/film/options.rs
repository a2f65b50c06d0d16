//! How a film is read.

use std::path::PathBuf;
use vibrissa::hw::Mounting;
use vibrissa::reconstruct::{ForceSettings, Frame, PolePrior};

/// Which ends of the rod the points show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// The first point is the base; the tip may not be seen.
    #[default]
    Base,
    /// The last point is the tip; the base may not be seen.
    Tip,
    /// Both: then the apparent shortening of the rod is known.
    Both,
    /// Neither.
    Neither,
}

/// How a film is read.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOptions {
    /// Metres per unit of the coordinates.
    pub scale: f64,
    /// Whether y counts down, as in images.
    pub image: bool,
    /// Which ends of the rod are seen.
    pub ends: Ends,
    /// A second table, of measured numbers by frame.
    pub channels: Option<PathBuf>,
    /// How the sensor sits whose components are among these numbers: an error without them. In the axes of the frames and at the base where it is not said.
    pub mounting: Option<Mounting>,
    /// A film of the free rod.
    pub rest: Option<PathBuf>,
    /// A pole that the rod touches, in the coordinates of the table.
    pub pole: Option<PolePrior>,
    /// Friction, noise and number of contacts.
    pub settings: ForceSettings,
}

impl FilmOptions {
    /// The settings, with the pole in m.
    pub(super) fn settings(&self) -> ForceSettings {
        let turned = if self.image { -1.0 } else { 1.0 };
        let in_metres = |pole: PolePrior| PolePrior {
            center: pole.center.map(|[x, y]| [self.scale * x, turned * self.scale * y]),
            sigma: pole.sigma.map(|sigma| self.scale * sigma),
            radius: pole.radius.map(|radius| self.scale * radius),
        };
        ForceSettings { pole: self.pole.map(in_metres), ..self.settings }
    }
}

impl Ends {
    /// A frame without points.
    pub(super) fn empty(self) -> Frame {
        Frame {
            base_is_first: matches!(self, Self::Base | Self::Both),
            tip_is_last: matches!(self, Self::Tip | Self::Both),
            ..Frame::default()
        }
    }
}
