//! From raw samples to the reactions at the clamp: rails, time, calibration, tare, stage, mounting.

mod rails;
mod signal_chain;
mod stage;
mod timekeeper;

pub use rails::{RailError, Rails};
pub use signal_chain::{ChainError, Correction, SensorError, SignalChain, WrenchChain};
pub use stage::{ConstantSpeed, FnStage, StageError, StageSource, Velocity};
#[cfg(feature = "std")]
pub use stage::{StageTable, StageTableError};
pub use timekeeper::{Timekeeper, TimingError};
