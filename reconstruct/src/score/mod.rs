//! Scores of a result against the truth: reactions, contours, phases, kinks (feature `score`).
//!
//! - [`goodness_of_fit`]: two signals, by the normalised mean square error (Merker et al. 2020, fig. 5).
//! - [`signed_distance`], [`Deviation`]: points against the true contour.
//! - [`Confusion`]: the phases found against the true ones.
//! - [`KinkScore`]: the kinks found against the true ones.
//!
//! A score that is not defined (without samples, for a constant reference, for a label that never occurs) is `None`, never NaN.

mod confusion;
mod deviation;
mod goodness;
mod kinks;

pub use confusion::Confusion;
pub use deviation::{Deviation, signed_distance};
pub use goodness::goodness_of_fit;
pub use kinks::{KinkMatch, KinkScore};
