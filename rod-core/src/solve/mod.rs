//! Solvers that know no rods: damped Newton's method, alone and under `argmin`, a trust region for bad guesses, the root of one
//! variable, and small dense matrices.

#[cfg(feature = "argmin")]
mod argmin_newton;
mod brent;
pub(crate) mod jacobian;
pub(crate) mod linear;
mod links;
mod newton;
mod system;
#[cfg(feature = "argmin")]
mod trust_region;

#[cfg(feature = "argmin")]
pub use argmin_newton::{NewtonSolver, NewtonState, RootProblem};
pub use brent::{Root, find_root};
pub use links::{Link, Links};
pub use newton::{NewtonOptions, NewtonWorkspace, SolveReport, SolveStatus, StepOutcome, newton_step, solve};
pub use system::System;
#[cfg(feature = "argmin")]
pub use trust_region::{Scaled, TrustRegionSearch, TrustRegionState, solve_by_trust_region};
