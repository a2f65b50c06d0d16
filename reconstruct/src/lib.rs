#![doc = include_str!("../README.md")]
//!
//! - [`single`]: the one contact behind the pose of the clamp and what it feels (a [`Sample`]), in closed form, and
//!   [`single_general`] for rods without one. [`NoContact`]: why there is none.
//! - [`reconstruct`]: a whole scan, its samples with their [`Label`]s, contacts ([`Touch`]), also both where there are two, and
//!   the [`Evidence`]. [`Live`]: the labels and single contacts as samples come.
//! - [`kink`], [`noise_estimate`]: where the reactions break, and how noisy they are.
//! - [`Assembly`]: contact points of a scan become a [`ContourEstimate`], stretches of a contour and gaps.
//! - [`align`], [`Comparison`], [`merge`]: how contours of several scans are offset, where they disagree, one of all.
//! - [`plausibility`]: whether a recording can be of the rod it is said to be of.
//! - [`NoiseModel`]: what a sensor makes of the true reactions, for simulated recordings. [`compare`]: how near a result is to
//!   the truth.
//!
//! This crate knows reactions, not sensors, and nothing of how a rod is swept: what it is told is where the clamp was and
//! what it felt. Units are SI at its border, dimensionless inside (lengths in L, forces in EI/L^2, moments in EI/L).
//!
//! Without the feature `std` there is no heap, and [`single`] is left, in `f32` or `f64`, for a microcontroller.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

#[cfg(feature = "std")]
mod assembly;
#[cfg(feature = "std")]
mod bound;
#[cfg(feature = "std")]
pub mod compare;
#[cfg(feature = "std")]
mod fit;
#[cfg(feature = "std")]
mod general;
#[cfg(feature = "std")]
pub mod kink;
mod known;
mod label;
#[cfg(feature = "std")]
mod live;
#[cfg(feature = "std")]
mod noise;
#[cfg(feature = "std")]
pub mod noise_estimate;
mod number;
#[cfg(feature = "std")]
mod phases;
#[cfg(feature = "std")]
mod plausibility;
#[cfg(feature = "std")]
mod reconstruction;
#[cfg(feature = "std")]
mod scans;
#[cfg(feature = "std")]
mod several;
mod single;
mod touch;
#[cfg(feature = "std")]
mod track;
#[cfg(feature = "std")]
mod travel;

// Covariances are its matrices.
pub use nalgebra;

#[cfg(feature = "std")]
pub use assembly::{
    Assembly, ContourEstimate, Gap, GapReason, Measured, Trace, TraceCurve, TraceKind, TracePoint, TraceRow,
};
#[cfg(feature = "std")]
pub use general::{GeneralError, single_general};
pub use label::Label;
#[cfg(feature = "std")]
pub use live::{Live, LiveSettings};
#[cfg(feature = "std")]
pub use noise::{Ar1, Dropout, NoiseError, NoiseGenerator, NoiseModel};
pub use number::Number;
#[cfg(feature = "std")]
pub use phases::{Basis, Evidence, Quantity};
#[cfg(feature = "std")]
pub use plausibility::{Finding, Plausibility, Shares, TangentialLine, plausibility};
#[cfg(feature = "std")]
pub use reconstruction::{Reading, Reason, ReconstructError, Reconstruction, Settings, reconstruct};
pub use rod_core::Sample;
#[cfg(feature = "std")]
pub use scans::{Comparison, Disagreement, Offset, align, merge};
#[cfg(feature = "std")]
pub use several::Unresolved;
pub use single::{NoContact, single};
pub use touch::Touch;
#[cfg(feature = "std")]
pub use track::Fault;
#[cfg(feature = "std")]
pub use travel::{Halt, Travel};
