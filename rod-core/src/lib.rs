#![doc = include_str!("../README.md")]
//!
//! - [`Rod`], [`Units`]: the rod in SI, and the one place that converts. [`VaryingRod`]: one that is not uniform or not straight at rest.
//! - [`Sample`]: where the clamp was and what it felt, as a sensor measures it.
//! - [`advance`], [`advance_with_sensitivities`], [`walk`], [`stations`]: one segment between two contacts in closed form.
//! - [`inflection`]: where a segment is straight.
//! - [`elastica_equilibria`]: the equilibria of a rod without contacts, under dead loads, with its [`Tip`] loaded or held, and their stability.
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

#[cfg(feature = "std")]
mod any_rod;
#[cfg(feature = "std")]
mod clamp;
#[cfg(feature = "std")]
mod elastica;
mod error;
#[cfg(feature = "std")]
mod judges;
#[cfg(feature = "std")]
mod model;
#[cfg(feature = "std")]
mod physical;
mod pose;
mod rod;
mod segment;
#[cfg(feature = "std")]
mod solve;
#[cfg(feature = "std")]
mod spec;
#[cfg(feature = "std")]
mod support_problem;
mod units;
#[cfg(feature = "std")]
mod varying;

// Their types are in the interface of `NewtonSolver`.
#[cfg(feature = "argmin")]
pub use {argmin, nalgebra};

#[cfg(feature = "std")]
pub use any_rod::{AnyClamp, AnyRod};
#[cfg(feature = "std")]
pub use clamp::{Clamp, ClampLaw, Elastic, ElasticClamp, Pivot, Roller, RollerHold};
#[cfg(feature = "std")]
pub use elastica::{
    DeadLoad, Elastica, ElasticaArgument, ElasticaEquilibrium, ElasticaError, Load, Tip, TipEnd, TipLoad,
    elastica_equilibria,
};
pub use error::RodError;
#[cfg(feature = "std")]
pub use judges::GeneralElastica;
#[cfg(feature = "ode")]
pub use judges::{Method, Ode};
#[cfg(feature = "std")]
pub use model::{
    Bent, Cone, Cut, CutSensitivities, Profile, Propagator, RodModel, RodSection, Sections, Smooth, Uniform,
};
#[cfg(feature = "std")]
pub use physical::{Guided, Mounted, PhysicalRod, RodParameter, RollerClamp};
pub use pose::{Pose, Reactions, Sample};
pub use rod::Rod;
pub use segment::{
    Dual, Scalar, Section, Segment, Sensitivities, Station, advance, advance_with_sensitivities, inflection, stations,
    walk,
};
#[cfg(feature = "std")]
pub use solve::{
    Link, Links, NewtonOptions, NewtonWorkspace, Root, SolveReport, SolveStatus, StepOutcome, System, find_root,
    newton_step, solve,
};
#[cfg(feature = "argmin")]
pub use solve::{
    NewtonSolver, NewtonState, RootProblem, Scaled, TrustRegionSearch, TrustRegionState, solve_by_trust_region,
};
#[cfg(feature = "std")]
pub use spec::{ClampSpec, CurvatureSpec, RodFault, RodSpec, SectionSpec, StiffnessSpec};
#[cfg(feature = "std")]
pub use support_problem::{
    ContactRate, Grip, Hold, Linearisation, MultiPoint, PathRow, Response, Support, SupportRate, Supports, arc_length,
};
pub use units::Units;
#[cfg(feature = "std")]
pub use varying::{NaturalCurvature, VaryingRod};
