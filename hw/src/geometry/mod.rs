//! Axes and lever arms: how the sensor sits under the clamp.

mod error;
mod frame;
mod mounting;

pub use error::GeometryError;
pub use frame::{Axis, Frame};
pub use mounting::{Mounting, Sense};
