//! Figures, as SVG.
//!
//! Colours are those of Okabe and Ito, told apart by colour-blind readers; every phase is labelled too.

mod abscissa;
mod canvas;
mod cloud;
mod contact_points;
mod contour;
mod criterion;
mod cycles;
mod distances;
mod elasticae;
mod goodness;
mod labels;
mod legend;
mod line;
mod notches;
mod outline;
mod palette;
mod plane;
mod profile;
mod reactions;
mod reconstruction;
mod sweep;
mod trace;
mod transitions;

pub use canvas::FigureError;
pub(crate) use contact_points::contact_points;
pub(crate) use criterion::criterion;
pub(crate) use cycles::cycles;
pub(crate) use distances::distances;
pub(crate) use goodness::goodness;
pub(crate) use notches::notches;
pub(crate) use profile::profile;
pub(crate) use reactions::reactions;
pub(crate) use reconstruction::reconstruction;
pub(crate) use sweep::sweep;
pub(crate) use transitions::transitions;
