//! Figures, as SVG: 180 mm wide at most, with letters of 8 pt.
//!
//! Colours are those of Okabe and Ito, told apart by colour-blind readers; every phase is labelled too.
//! A phase has the same colour in all figures, and nothing else has it.

mod abscissa;
mod budget;
mod calibration;
pub(crate) mod canvas;
pub(crate) mod chart;
pub(crate) mod cloud;
mod contour;
mod elasticae;
pub(crate) mod element;
mod equilibria;
mod film;
mod fitted;
pub(crate) mod labels;
mod legend;
mod line;
mod merged;
mod outline;
pub(crate) mod palette;
mod plan;
pub(crate) mod plane;
mod profile;
mod reach;
mod reactions;
mod reconstruction;
mod residuals;
mod scale;
mod support;
mod sweep;
mod text;
pub(crate) mod trace;

pub(crate) use budget::budget;
pub(crate) use calibration::{Residual, calibration};
pub use canvas::FigureError;
pub(crate) use equilibria::equilibria;
pub(crate) use film::{frames, over_frames};
pub(crate) use merged::merged;
pub(crate) use plan::{approaches, plan};
pub(crate) use profile::profile;
pub(crate) use reach::reach;
pub(crate) use reactions::reactions;
pub(crate) use reconstruction::reconstruction;
pub(crate) use residuals::residuals;
pub(crate) use sweep::sweep;
