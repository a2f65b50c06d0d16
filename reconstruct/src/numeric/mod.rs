//! Numerical methods that more than one room of this crate needs. Nothing here knows a rod or a contact.

#[cfg(feature = "std")]
mod angle;
#[cfg(feature = "std")]
pub(crate) mod chi_squared;
mod covariance;
#[cfg(feature = "std")]
mod gram_schmidt;
#[cfg(feature = "std")]
pub(crate) mod legendre;
#[cfg(feature = "std")]
mod normal_equations;
mod number;
#[cfg(feature = "std")]
mod robust;
#[cfg(test)]
pub(crate) mod seeded;

#[cfg(feature = "std")]
pub(crate) use angle::wrap_angle;
pub(crate) use covariance::propagate_covariance;
#[cfg(feature = "std")]
pub(crate) use covariance::{inverse, squared_distance, variance};
#[cfg(feature = "std")]
pub(crate) use gram_schmidt::{dot, orthonormalise, subtract};
#[cfg(feature = "std")]
pub(crate) use normal_equations::NormalEquations;
pub use number::Number;
#[cfg(feature = "std")]
pub(crate) use robust::{median, robust_sigma};

/// Standard deviations within which a difference counts as chance: 6e-5 of normal numbers are beyond. Larger: errors must be larger to be
/// found; smaller: good recordings get findings.
#[cfg(feature = "std")]
pub(crate) const CHANCE: f64 = 4.0;
