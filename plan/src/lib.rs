#![doc = include_str!("../README.md")]
//!
//! - [`Outline`]: the border of an object by arc length. [`IntervalSet`]: parts of it.
//! - [`Touched`]: the parts that the contacts of a sweep go over.
//! - [`StraightScan`]: a scan by its distance and angle. [`reach`]: what the scans of a grid touch, on all cores.
//! - [`plan`]: from what is known of a contour ([`FittedObject`](rod_reconstruct::FittedObject)), what each of some candidate scans is expected to add, its precision, time and load;
//!   [`Plan::greedy`] takes several of them.
//! - [`KnownScan`]: how exactly one scan of a known object determines its contour, for the choice of rod and sensor.
//!
//! - [`Explorer`]: proposes scans, takes what was measured on them, and proposes the next ones, until nothing is left to find.
//!
//! This crate knows nothing of files.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod choice;
mod design;
mod error;
mod explore;
mod forecast;
mod hypothesis;
mod interval_set;
mod joined;
mod outline;
mod precision;
mod reach;
mod scan;
mod scanned;
mod support;
mod touched;

pub use choice::{Choice, exhaustive, greedy};
pub use design::KnownScan;
pub use error::PlanError;
pub use explore::{Abort, ExploreError, Explorer, ExplorerSettings, Finish, Proposal, Purpose, Rectangle, Stage};
pub use forecast::{Candidate, Forecast, Gain, KnownPoint, Plan, PlanSettings, candidates, plan, straight_candidates};
pub use hypothesis::Hypothesis;
pub use interval_set::IntervalSet;
pub use outline::Outline;
pub use precision::{Measurement, PlaceSigma};
pub use reach::{Reach, ReachGrid, ScanReach, reach};
pub use scan::{Pass, StraightScan};
pub use scanned::Scanned;
pub use touched::Touched;
