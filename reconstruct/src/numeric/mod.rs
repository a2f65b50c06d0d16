//! Numerical methods that more than one room of this crate needs.

#[cfg(feature = "std")]
pub(crate) mod chi_squared;
pub(crate) mod number;
#[cfg(test)]
pub(crate) mod seeded;
