//! Simulated sensors: what becomes of true reactions on their way into a recording.
//!
//! `model` says what is wrong with a sensor, `file` how that is written down, `generator` does it to one sample after
//! the other.

mod error;
mod file;
mod generator;
mod model;

pub use error::NoiseError;
pub use generator::NoiseGenerator;
pub use model::{Ar1, Dropout, NoiseModel};
