//! A calibration: what one or several recordings of a rod tell of rod, sensor, clamp and stage.
//!
//! `freed` says which sources are looked for, `result` computes them, `file` writes what is known of the rod then, and `report` tells it
//! to people.

mod file;
mod freed;
mod report;
mod result;

pub use freed::Freed;
pub use result::{CalibrateError, RodCalibration};
