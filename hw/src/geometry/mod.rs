//! The mounting of the sensor: axes, lever arm, sense.

mod frame;
mod mounting;

pub use frame::{Axis, Frame};
pub use mounting::{Mounting, Sense};

/// Why there is no such frame or mounting.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A number that is not finite, or not allowed for this quantity.
    #[error("{what} is {value}, expected {expected}")]
    Value {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// Two axes along the same line.
    #[error("two of the axes lie along the same line, expected one along each of x, y and z")]
    SameAxis,
    /// A mirror image.
    #[error("the axes are left-handed, expected right-handed ones: x cross y is z; check the sign of one of them")]
    LeftHanded,
    /// A text that names no axis.
    #[error("no axis of this name, expected one of x, -x, y, -y, z, -z")]
    NoAxis,
}
