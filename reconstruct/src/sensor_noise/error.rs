//! What can be wrong with a noise model.

/// Why a noise model is not possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// A number that is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Value {
        /// Which one, as in `white.f0x` or `crosstalk[1][3]`, rows and columns counted from 1.
        field: String,
        /// Its value as given.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}
