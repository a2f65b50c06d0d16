//! Simulated sensors: from true reactions to readings with the errors of a sensor (feature `sensor-noise`).
//!
//! `model` describes the errors, `file` how they are written in a file, and `generator` applies them to one sample after the other.

#[cfg(feature = "serde")]
mod file;
mod generator;
mod model;

pub use generator::NoiseGenerator;
pub use model::{Ar1, Dropout, NoiseError, NoiseModel};
