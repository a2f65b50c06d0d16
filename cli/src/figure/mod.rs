//! Figures, as SVG.
//!
//! Colours are those of Okabe and Ito, told apart by colour-blind readers; every phase is labelled too.

mod abscissa;
mod canvas;
mod contour;
mod criterion;
mod cycles;
mod elasticae;
mod labels;
mod legend;
mod line;
mod outline;
mod palette;
mod plane;
mod profile;
mod sweep;
mod trace;

pub use canvas::FigureError;
pub(crate) use criterion::criterion;
pub(crate) use cycles::cycles;
pub(crate) use profile::profile;
pub(crate) use sweep::sweep;
