//! The mounting of the sensor: axes, lever arm, sense.

mod error;
mod frame;
mod mounting;

pub use error::GeometryError;
pub use frame::{Axis, Frame};
pub use mounting::{Mounting, Sense};
