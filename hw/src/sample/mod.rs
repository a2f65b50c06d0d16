//! Samples: raw values, wrenches and reactions, with units and quality flags.

mod component;
mod quality;
mod raw;
mod si_samples;
mod unit;
mod wrench;

pub use component::Component;
pub use quality::Quality;
pub use raw::{Channels, RawSample};
pub use si_samples::{OutOfPlane, ReactionSample, WrenchSample};
pub use unit::{Dimension, Unit, UnitError};
pub use wrench::{Number, Wrench};
