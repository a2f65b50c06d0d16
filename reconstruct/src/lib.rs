//! From what the clamp feels back to the object: contact points, contact phases, contours.
//!
//! - [`Sample`]: clamp pose and reactions at one instant; [`Label`]: in which contact phase it was.
//! - [`Assembly`]: contact points of a scan become a [`ContourEstimate`], stretches of a contour and gaps.
//! - [`align`], [`Comparison`], [`merge`]: how contours of several scans are offset, where they disagree, one of all.
//!
//! This crate knows reactions, not sensors, and nothing of how a rod is swept: what it is told is where the clamp was and
//! what it felt. Units are SI at its border, dimensionless inside (lengths in L, forces in EI/L^2, moments in EI/L).
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod assembly;
mod label;
mod sample;
mod scans;
mod touch;

pub use assembly::{
    Assembly, ContourEstimate, Gap, GapReason, Measured, Trace, TraceCurve, TraceKind, TracePoint, TraceRow,
};
pub use label::Label;
pub use sample::Sample;
pub use scans::{Comparison, Disagreement, Offset, align, merge};
pub use touch::Touch;
