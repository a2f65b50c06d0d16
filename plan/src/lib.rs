#![doc = include_str!("../README.md")]
//!
//! - [`Outline`]: the border of an object by arc length. [`IntervalSet`]: parts of it.
//! - [`Touched`]: the parts that the contacts of a sweep go over.
//! - [`StraightScan`]: a scan by its distance and angle. [`reach`]: what the scans of a grid touch, on all cores.
//!
//! This crate knows nothing of files.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod error;
mod interval_set;
mod outline;
mod reach;
mod scan;
mod support;
mod touched;

pub use error::PlanError;
pub use interval_set::IntervalSet;
pub use outline::Outline;
pub use reach::{Reach, ReachGrid, ScanReach, reach};
pub use scan::{Pass, StraightScan};
pub use touched::Touched;
