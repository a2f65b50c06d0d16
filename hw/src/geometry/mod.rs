//! The mounting of the sensor: axes, lever arm, sense.

mod error;
mod frame;
#[cfg(feature = "std")]
mod lever_arm;
mod mounting;

pub use error::GeometryError;
pub use frame::{Axis, Frame};
#[cfg(feature = "std")]
pub use lever_arm::{LeverArm, fit_lever_arm};
pub use mounting::{Mounting, Sense};
