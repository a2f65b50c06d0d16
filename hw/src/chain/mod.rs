//! From raw samples to the reactions at the clamp: rails, time, calibration, tare, stage, mounting.

mod rails;
mod signal_chain;
mod stage;
mod timekeeper;

pub use rails::{RailError, Rails};
pub use signal_chain::{ChainError, Correction, SensorError, SignalChain, WrenchChain};
#[cfg(feature = "std")]
pub use stage::StageTable;
pub use stage::{ConstantSpeed, FnStage, StageError, StageSource, Velocity};
pub use timekeeper::{Timekeeper, TimingError};
