//! Studies: one scene with some of its numbers changed, in all combinations, and one row of results for each.
//!
//! `document` is the file as written, `parameter` what is changed, `grid` the scenes, `row` what is measured in each,
//! `touched` how much of the objects the rod went over, and `run` writes the rows part by part, so that a run that was
//! broken off goes on where it was.

mod document;
mod field;
mod grid;
mod parameter;
mod row;
mod run;
mod touched;

pub use document::StudyError;
pub use grid::Study;
pub use row::{Measured, StudyRow};
pub use run::StudyRun;
