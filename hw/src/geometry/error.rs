//! Why there is no such frame, mounting or lever arm.

/// Why there is no such frame, mounting or lever arm.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A number that is none, or cannot be what it is given for.
    #[error("{what} is {value}, expected {expected}")]
    Value {
        /// What it is given for.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// Too few loads for a lever arm.
    #[error("{found} loads, expected 2 or more in different directions")]
    Few {
        /// How many there are.
        found: usize,
    },
    /// A load of a lever arm is not finite.
    #[error("load {load} is not finite, expected finite numbers of N and N m")]
    NotFinite {
        /// Its number, from 1.
        load: usize,
    },
    /// The forces are nearly parallel: they leave the arm along them open.
    #[error(
        "the forces differ by a sine of {spread:.3} only, expected 0.05 or more; hang weights in other directions, or turn the sensor"
    )]
    Parallel {
        /// Sine by which they differ, root mean square.
        spread: f64,
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
