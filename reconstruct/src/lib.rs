#![doc = include_str!("../README.md")]
//!
//! - [`single`]: the contact point of one contact from one [`Sample`] (pose of the clamp and reactions), in closed form, and
//!   [`one_sample`] for any rod, with the kind of contact; [`single_general`] through any integrator. [`NoContact`]: why there is none.
//!   [`through_roller`]: the same of a rod that runs through a roller ahead of its clamp, with a check of stiffness and gain;
//!   [`beyond_roller`]: the sample without the roller.
//! - [`reconstruct`]: a whole scan. Each sample gets its [`Label`] and its contacts ([`Touch`]), both of them where there are two,
//!   and the [`Evidence`]. [`Live`]: labels and single contacts as samples come.
//! - [`passes`]: the parts of a recording whose clamp turns back, and [`reconstruct_passes`] for all of them; [`reconstruct_general`] for
//!   any rod on any clamp.
//! - [`forces`]: forces from shapes. A [`Frame`] has points on the rod, measured numbers at its base ([`Channel`]), or both; of each frame the contacts
//!   with place and force, the reactions, their covariance, and a [`FrameVerdict`]: what it cannot tell. [`rest_shape`]:
//!   the curvature at rest from frames of the free rod.
//! - [`kink`], [`noise_estimate`]: the places where the reactions have kinks and jumps, and their noise.
//! - [`Assembly`]: contact points of a scan become a [`ContourEstimate`], stretches of a contour and gaps.
//! - [`align`], [`Comparison`], [`merge`]: offsets of the contours of several scans, where they disagree, and one contour from all.
//! - [`plausibility`]: whether a recording can be of the rod that is given.
//! - `NoiseModel` (feature `sensor-noise`): simulated sensors. `score` (feature `score`): scores of a result against the truth.
//!
//! This crate needs reactions only: it does not depend on sensors, nor on how a rod is swept. Only with the feature `contact` it knows
//! `rod-contact`, for which [`Reading::guess`] and `Contact::from` make guesses. Units are SI at its border and
//! dimensionless inside (lengths in L, forces in EI/L^2, moments in EI/L).
//!
//! Without the feature `std` there is no heap. [`single`] is left, in `f32` or `f64`, for a microcontroller.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

#[cfg(feature = "std")]
mod check;
#[cfg(feature = "std")]
mod contour;
#[cfg(feature = "contact")]
mod fit;
#[cfg(feature = "contact")]
mod forward;
#[cfg(feature = "std")]
mod frames;
#[cfg(feature = "std")]
mod friction;
#[cfg(feature = "std")]
pub mod kink;
#[cfg(feature = "std")]
mod least_squares;
#[cfg(feature = "std")]
mod merge;
mod numeric;
mod phase;
#[cfg(feature = "std")]
mod pipeline;
mod point;
#[cfg(feature = "std")]
mod scan;
#[cfg(feature = "score")]
pub mod score;
#[cfg(feature = "sensor-noise")]
mod sensor_noise;
#[cfg(feature = "std")]
mod systematic;
#[cfg(feature = "std")]
mod two_contacts;

// Covariances are its matrices.
pub use nalgebra;

#[cfg(feature = "std")]
pub use check::{Finding, Mistake, Plausibility, Shares, TangentialLine, plausibility, plausibility_with_friction};
#[cfg(feature = "std")]
pub use contour::{Assembly, ContourEstimate, Gap, GapReason, Measured, Trace, TraceKind, TracePoint, TraceRow};
#[cfg(feature = "contact")]
pub use fit::{
    ContourFit, FitError, FittedBlock, FittedObject, Goodness, Knowledge, ShapeKind, SimpleShape, WorstWindow,
    fit_contour, fit_contours,
};
#[cfg(feature = "std")]
pub use frames::{
    Axis, Channel, FamilyMember, Film, FilmPole, ForceSettings, Frame, FrameContact, FrameFault, FrameForces,
    FrameVerdict, HiddenBase, Measurand, PolePrior, RestError, RestShape, SeenPoint, forces, rest_shape,
};
#[cfg(feature = "std")]
pub use friction::{Friction, FrictionAlone, FrictionEstimate};
#[cfg(feature = "std")]
pub use merge::{Comparison, Disagreement, Offset, align, merge};
pub use numeric::Number;
pub use phase::Label;
#[cfg(feature = "std")]
pub use phase::{Basis, Evidence, Quantity};
#[cfg(feature = "std")]
pub use pipeline::{
    Explanation, Live, LiveSession, LiveSettings, Pass, Reading, Reason, ReconstructError, Reconstruction, Settings,
    explanations, reconstruct, reconstruct_general, reconstruct_passes,
};
#[cfg(feature = "std")]
pub use point::{
    Estimate, GeneralError, OneSample, ThroughRoller, beyond_roller, one_sample, single_general, through_roller,
};
pub use point::{NoContact, Touch, single, single_with_friction};
pub use rod_core::Sample;
#[cfg(feature = "std")]
pub use scan::{FEWEST_SAMPLES, Fault, Halt, Travel, noise_estimate, passes};
#[cfg(feature = "sensor-noise")]
pub use sensor_noise::{Ar1, Dropout, NoiseError, NoiseGenerator, NoiseModel};
#[cfg(feature = "std")]
pub use systematic::{Budget, Calibration, Combined, Influence, Known, Source, SourceEstimate, disturb, influences};
#[cfg(feature = "std")]
pub use two_contacts::Unresolved;
