//! A sensor, read and reconstructed as it measures.

mod address;
mod engine;
mod stage;

pub use address::{AddressError, SensorAddress};
pub use engine::{Answer, Engine};
pub use stage::{StageSpec, StageSpecError};
