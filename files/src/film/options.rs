//! How a film is read.

use std::path::PathBuf;
use vibrissa::hw::Mounting;
use vibrissa::reconstruct::{ForceSettings, Frame};

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
    /// How the sensor sits whose components are among these numbers.
    pub mounting: Mounting,
    /// A film of the free rod.
    pub rest: Option<PathBuf>,
    /// Friction, noise and number of contacts.
    pub settings: ForceSettings,
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
