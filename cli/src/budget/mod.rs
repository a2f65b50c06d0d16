//! What accuracy to expect of a scene: the errors that all samples share, through the reconstruction.
//!
//! `truth` is the scene as a perfect sensor records it. `forecast` says by derivatives how far each source of error displaces contact
//! points, before and after a scan calibrates itself, and `needed` scales that to another sensor. `trials` draws errors, puts them on the
//! samples and reconstructs. `files` writes the results, `report` tells them.

mod error;
mod files;
mod forecast;
mod needed;
mod report;
mod study;
mod trials;
mod truth;

pub use error::BudgetError;
pub(crate) use forecast::Forecast;
pub use study::{BudgetStudy, Expected};
