//! What computes a rod by other means than the solver, and so checks it: the shape under forces through any propagator, and the
//! integration of the differential equations.

mod general;
#[cfg(feature = "ode")]
mod ode;

pub use general::GeneralElastica;
#[cfg(feature = "ode")]
pub use ode::{Method, Ode};
