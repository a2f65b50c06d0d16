#![doc = include_str!("../README.md")]
//!
//! - [`Rod`], [`Units`]: the rod in SI, and the one place that converts. [`VaryingRod`]: one that is not uniform or not straight at rest.
//! - [`Sample`]: where the clamp was and what it felt, as a sensor measures it.
//! - [`advance`], [`advance_with_sensitivities`], [`walk`], [`stations`]: one segment between two contacts in closed form.
//! - [`inflection`]: where a segment is straight.
//! - [`Elastica`]: the whole rod under any number of forces. [`GeneralElastica`] and [`Propagator`]: the same through the closed
//!   form or through differential equations ([`Ode`]), the way for rods that vary along their length.
//! - [`RodModel`]: what a rod of any kind answers, with exact derivatives. [`Uniform`], [`Sections`], [`Smooth`].
//! - [`MultiPoint`]: the boundary-value problem of a rod on any number of supports, with its exact Jacobian.
//! - [`Clamp`]: how the base of the rod is held there, rigidly by a [`Pose`], on springs ([`ElasticClamp`], [`Elastic`]), or on a [`Pivot`].
//! - [`solve`], [`NewtonSolver`]: damped Newton's method as a plain loop and under `argmin`; [`solve_by_trust_region`] from guesses
//!   from which it fails; [`find_root`] for one variable.
//!
//! Conventions: s from the clamp (0) to the tip; phi the slope angle, kappa = phi'; x' = cos phi, y' = sin phi. A
//! support with tangent angle alpha, its solid to the left, pushes with the force f (sin alpha, -cos alpha), f >= 0.
//! With A = sum f cos alpha and B = sum f sin alpha over the supports ahead, kappa' = A cos phi + B sin phi. The clamp
//! feels f0x = -B, f0y = A, m0z = -E I kappa(0). (Merker et al. 2020, with the signs of their eq. 10 and Appendix A.)
//!
//! This crate knows no contours: supports are whatever implements [`Supports`].
//!
//! Without the feature `std` there is no heap: what needs one is left out, what stays are the rod, its clamp and one segment,
//! generic over the number ([`Scalar`]), for a microcontroller in `f32`.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod agm;
#[cfg(feature = "std")]
mod any_rod;
#[cfg(feature = "argmin")]
mod argmin_newton;
mod basis;
#[cfg(feature = "std")]
mod brent;
mod circular;
#[cfg(feature = "std")]
mod clamp;
mod dual;
#[cfg(feature = "std")]
mod elastica;
mod error;
#[cfg(feature = "std")]
mod general;
#[cfg(feature = "std")]
mod grip;
mod inflection;
#[cfg(feature = "std")]
mod linear;
#[cfg(feature = "std")]
mod linearisation;
#[cfg(feature = "std")]
mod loads;
#[cfg(feature = "std")]
mod model;
#[cfg(feature = "std")]
mod multipoint;
#[cfg(feature = "std")]
mod newton;
#[cfg(feature = "ode")]
mod ode;
#[cfg(feature = "std")]
mod physical;
mod pose;
#[cfg(feature = "std")]
mod propagator;
mod rod;
mod sample;
mod scalar;
mod segment;
#[cfg(feature = "std")]
mod spec;
#[cfg(feature = "argmin")]
mod trust_region;
mod units;
#[cfg(feature = "std")]
mod varying;
mod walk;

// Their types are in the interface of `NewtonSolver`.
#[cfg(feature = "argmin")]
pub use {argmin, nalgebra};

#[cfg(feature = "std")]
pub use any_rod::{AnyClamp, AnyRod};
#[cfg(feature = "argmin")]
pub use argmin_newton::{NewtonSolver, NewtonState, RootProblem};
#[cfg(feature = "std")]
pub use brent::{Root, find_root};
#[cfg(feature = "std")]
pub use clamp::{Clamp, ClampLaw, Elastic, ElasticClamp, Guided, Mounted, Pivot, Roller, RollerClamp, RollerHold};
pub use dual::Dual;
#[cfg(feature = "std")]
pub use elastica::Elastica;
pub use error::RodError;
#[cfg(feature = "std")]
pub use general::GeneralElastica;
#[cfg(feature = "std")]
pub use grip::{Grip, arc_length};
pub use inflection::inflection;
#[cfg(feature = "std")]
pub use linearisation::{ContactRate, Linearisation, PathRow, Response, SupportRate};
#[cfg(feature = "std")]
pub use loads::Load;
#[cfg(feature = "std")]
pub use model::{Bent, Cone, CutSensitivities, Profile, RodModel, RodSection, Sections, Smooth, Uniform};
#[cfg(feature = "std")]
pub use multipoint::{Hold, MultiPoint, Support, Supports};
#[cfg(feature = "std")]
pub use newton::{NewtonOptions, NewtonWorkspace, SolveReport, SolveStatus, StepOutcome, System, newton_step, solve};
#[cfg(feature = "ode")]
pub use ode::{Method, Ode};
#[cfg(feature = "std")]
pub use physical::{PhysicalRod, RodParameter};
pub use pose::{Pose, Reactions};
#[cfg(feature = "std")]
pub use propagator::{Cut, Propagator};
pub use rod::Rod;
pub use sample::Sample;
pub use scalar::Scalar;
pub use segment::{Section, Segment, Sensitivities, advance, advance_with_sensitivities};
#[cfg(feature = "std")]
pub use spec::{ClampSpec, CurvatureSpec, RodFault, RodSpec, SectionSpec, StiffnessSpec};
#[cfg(feature = "argmin")]
pub use trust_region::{Scaled, TrustRegionSearch, TrustRegionState, solve_by_trust_region};
pub use units::Units;
#[cfg(feature = "std")]
pub use varying::{NaturalCurvature, VaryingRod};
pub use walk::{Station, stations, walk};
