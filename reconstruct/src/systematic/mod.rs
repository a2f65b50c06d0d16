//! Errors that all samples of a scan share: bias and drift of the sensor, gains, cross-talk, the angle of the clamp, the lever arm,
//! stiffness, length and natural curvature of the rod, the compliance of the clamp, the stage.
//!
//! They do not average out. `Budget` says how large each may be. `Correction` takes them off a sample, `influence` says how the
//! criteria of a place depend on them, `free` finds the stretches of the free rod, `estimate_errors` estimates them from labelled places, and
//! `calibrate` estimates labels and errors in turns. `known` is what a calibration tells of later scans, `combined` what several scans
//! tell together, `candidates` which single source explains a scan. For simulations `disturb` puts errors on true samples, and `across` says how far they displace contact points.

mod across;
mod alternation;
mod budget;
mod calibrate;
mod calibration;
mod candidates;
mod combined;
mod correction;
mod disturb;
mod estimate_errors;
mod free;
mod influence;
mod known;
mod remaining;
mod source;

pub use across::{Influence, influences};
pub use budget::Budget;
pub(crate) use calibrate::{CalibrationScan, calibrate, calibrate_labelled, errors_before_scan, log_likelihood};
#[cfg(feature = "contact")]
pub(crate) use calibration::BEYOND;
pub use calibration::{Calibration, SourceEstimate};
pub(crate) use candidates::{SourceCandidate, candidates};
pub use combined::Combined;
pub(crate) use correction::Correction;
#[cfg(feature = "contact")]
pub(crate) use correction::{Frame, motion, still};
pub use disturb::disturb;
pub(crate) use influence::{CorrectionDifferences, point_covariance};
pub use known::Known;
pub(crate) use remaining::{DISPLACED, RemainingErrors};
pub(crate) use source::Errors;
pub use source::Source;
