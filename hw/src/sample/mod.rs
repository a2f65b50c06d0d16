//! Samples: raw values, wrenches and reactions, with units and quality flags.

mod component;
mod number;
mod quality;
mod raw;
mod reaction_sample;
mod unit;
mod wrench;
mod wrench_sample;

pub use component::Component;
pub use number::Number;
pub use quality::Quality;
pub use raw::{Channels, RawSample};
pub use reaction_sample::{OutOfPlane, ReactionSample};
pub use unit::{Dimension, Unit, UnitError};
pub use wrench::Wrench;
pub use wrench_sample::WrenchSample;
