//! From raw samples to the reactions at the clamp: rails, time, calibration, tare, stage, mounting.

mod error;
mod rails;
mod signal_chain;
mod stage;
mod timekeeper;

pub use error::{ChainError, SensorError};
pub use rails::Rails;
pub use signal_chain::{SignalChain, WrenchChain};
#[cfg(feature = "std")]
pub use stage::StageTable;
pub use stage::{ConstantSpeed, StageError, StageSource, Velocity};
pub use timekeeper::Timekeeper;
