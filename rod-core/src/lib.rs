//! Mechanics of one thin elastic rod.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod argmin_newton;
mod basis;
mod brent;
mod dual;
mod elastica;
mod error;
mod general;
mod linear;
mod loads;
mod multipoint;
mod newton;
mod ode;
mod pose;
mod propagator;
mod rod;
mod scalar;
mod segment;
mod units;
mod walk;

pub use argmin_newton::{NewtonSolver, NewtonState, RootProblem};
pub use brent::{Root, find_root};
pub use dual::Dual;
pub use elastica::{Elastica, Load};
pub use error::RodError;
pub use general::GeneralElastica;
pub use multipoint::{Hold, MultiPoint, Support, Supports};
pub use newton::{
    NewtonOptions, NewtonWorkspace, SolveReport, SolveStatus, StepOutcome, System, newton_step, prepare, report, solve,
};
pub use ode::{Method, Ode};
pub use pose::{Pose, Reactions};
pub use propagator::{ClosedForm, Cut, Propagator};
pub use rod::Rod;
pub use scalar::Scalar;
pub use segment::{Section, Sensitivities, advance, advance_with_sensitivities};
pub use units::Units;
pub use walk::walk;
