//! A scan: its samples in order along the path of the clamp, their noise, and smooth local fits of the reactions.
//!
//! [`Travel`] is the path parameter, `Track` the dimensionless samples, [`noise_estimate`] the noise of each channel, and
//! `LocalCubic` gives values and rates of pose and reactions at a place, with their covariance.

pub(crate) mod bands;
mod local_cubic;
mod noise;
pub mod noise_estimate;
mod polynomials;
mod quantum;
mod track;
mod travel;

pub(crate) use local_cubic::{Estimate, LocalCubic};
pub(crate) use noise::{Noise, dimensionless};
pub use track::Fault;
pub(crate) use track::{Intake, Track};
pub use travel::{Halt, Travel};
