//! Axes and lever arms: how the sensor sits under the clamp.

mod frame;
#[cfg(feature = "std")]
mod lever_arm;
mod mounting;

pub use frame::{Axis, Frame, FrameError};
#[cfg(feature = "std")]
pub use lever_arm::{LeverArm, LeverArmError, fit_lever_arm};
pub use mounting::{Mounting, Sense};
