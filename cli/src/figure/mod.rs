//! Figures, as SVG: 180 mm wide at most, with letters of 8 pt.
//!
//! Colours are those of Okabe and Ito, told apart by colour-blind readers; every phase is labelled too.
//! A phase has the same colour in all figures, and nothing else has it.

mod abscissa;
mod canvas;
mod chart;
mod cloud;
mod contact_points;
mod contour;
mod criterion;
mod cycles;
mod distances;
mod elasticae;
mod element;
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
mod text;
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
