//! From what the clamp feels back to the object: contact points, contact phases, contours.
//!
//! - [`single`]: the one contact behind the pose of the clamp and what it feels (a [`Sample`]), in closed form, and
//!   [`single_general`] for rods without one. [`NoContact`]: why there is none.
//! - [`reconstruct`]: a whole scan, its samples with their [`Label`]s, contacts ([`Touch`]), also both where there are two, and
//!   the [`Evidence`]. [`Live`]: the labels and single contacts as samples come.
//! - [`kink`], [`noise_estimate`]: where the reactions break, and how noisy they are.
//! - [`Assembly`]: contact points of a scan become a [`ContourEstimate`], stretches of a contour and gaps.
//! - [`align`], [`Comparison`], [`merge`]: how contours of several scans are offset, where they disagree, one of all.
//! - [`plausibility`]: whether a recording can be of the rod it is said to be of.
//! - [`NoiseModel`]: what a sensor makes of the true reactions, for simulated recordings. [`score`]: how near a result is to
//!   the truth.
//!
//! This crate knows reactions, not sensors, and nothing of how a rod is swept: what it is told is where the clamp was and
//! what it felt. Units are SI at its border, dimensionless inside (lengths in L, forces in EI/L^2, moments in EI/L).
//!
//! Without the feature `std` there is no heap, and [`single`] is left, in `f32` or `f64`, for a microcontroller.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

#[cfg(feature = "std")]
mod check;
#[cfg(feature = "std")]
mod contour;
#[cfg(feature = "std")]
pub mod kink;
#[cfg(feature = "std")]
mod merge;
mod numeric;
mod phase;
#[cfg(feature = "std")]
mod pipeline;
mod point;
#[cfg(feature = "std")]
mod scan;
#[cfg(feature = "std")]
pub mod score;
#[cfg(feature = "std")]
mod sensor_noise;
#[cfg(feature = "std")]
mod two_contacts;

#[cfg(feature = "std")]
pub use check::{Finding, Plausibility, Shares, TangentialLine, plausibility};
#[cfg(feature = "std")]
pub use contour::{
    Assembly, ContourEstimate, Gap, GapReason, Measured, Trace, TraceCurve, TraceKind, TracePoint, TraceRow,
};
#[cfg(feature = "std")]
pub use merge::{Comparison, Disagreement, Offset, align, merge};
pub use numeric::number::Number;
pub use phase::label::Label;
#[cfg(feature = "std")]
pub use phase::{Basis, Evidence, Quantity};
#[cfg(feature = "std")]
pub use pipeline::live::{Live, LiveSettings};
#[cfg(feature = "std")]
pub use pipeline::reconstruction::{Reading, Reason, ReconstructError, Reconstruction, Settings, reconstruct};
pub use point::single::{NoContact, single};
#[cfg(feature = "std")]
pub use point::single_general::{GeneralError, single_general};
pub use point::touch::Touch;
pub use rod_core::Sample;
#[cfg(feature = "std")]
pub use scan::noise_estimate;
#[cfg(feature = "std")]
pub use scan::track::Fault;
#[cfg(feature = "std")]
pub use scan::travel::{Halt, Travel};
#[cfg(feature = "std")]
pub use sensor_noise::{Ar1, Dropout, NoiseError, NoiseGenerator, NoiseModel};
#[cfg(feature = "std")]
pub use two_contacts::Unresolved;
