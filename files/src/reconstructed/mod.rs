//! A recording, turned back into contact points, phases and a contour.
//!
//! `result` computes all of it, `together` fits several recordings, and `truth` compares it with the scene that the recording is of (`comparison`). `files` writes the
//! files: `points` is the line of a sample, `report` describes the whole, and `summary` does so for people.

mod comparison;
mod files;
mod fit;
mod points;
mod report;
mod result;
mod summary;
mod together;
mod truth;

pub use comparison::{Comparison, Transition, TruthError};
pub use files::COLUMNS as CONTOUR_COLUMNS;
pub use fit::FittedPoint;
pub(crate) use points::PointRecord;
pub use result::{Reconstructed, ReconstructionError};
pub use summary::confounders_text;
pub use together::Together;
pub use truth::naive_touch;
