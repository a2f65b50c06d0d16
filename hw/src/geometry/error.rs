//! Why there is no such frame or mounting.

/// Why there is no such frame or mounting.
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
    /// Axes that are not of length 1, or not at right angles.
    #[error(
        "axes {a} and {b} have the product {product}, expected {} to within 1e-3; are these the columns or rows of a rotation?",
        u8::from(.a == .b)
    )]
    NotOrthonormal {
        /// The one, from 1.
        a: usize,
        /// The other.
        b: usize,
        /// Their scalar product.
        product: f64,
    },
    /// A mirror image.
    #[error("the axes are left-handed, expected right-handed ones: x cross y is z; check the sign of one of them")]
    LeftHanded,
    /// A text that names no axis.
    #[error("no axis of this name, expected one of x, -x, y, -y, z, -z")]
    NoAxis,
}
