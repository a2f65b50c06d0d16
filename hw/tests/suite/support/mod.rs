//! What tests share.

mod simulated;

pub use simulated::{Counts, SimulatedSensor};
