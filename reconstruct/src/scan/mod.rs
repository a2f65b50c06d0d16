//! A scan: its samples in order along the path of the clamp, their noise, and smooth local fits of the reactions.
//!
//! [`passes`] splits a recording whose clamp turns back. [`Travel`] is the path parameter, `Track` the dimensionless samples, whose
//! poses are smoothed where they tremble, [`noise_estimate`] the noise of each channel, and
//! `LocalCubic` gives values and rates of pose and reactions at a place, with their covariance.

mod autoregression;
pub(crate) mod bands;
mod frozen;
mod local_cubic;
mod noise;
pub mod noise_estimate;
mod passes;
mod polynomials;
mod quantum;
mod smooth_path;
mod spikes;
mod stops;
mod track;
mod travel;

pub(crate) use local_cubic::{LocalCubic, LocalEstimate};
pub(crate) use noise::{Noise, dimensionless};
pub use passes::passes;
pub(crate) use quantum::quantum;
pub use track::Fault;
pub(crate) use track::{SampleNumber, SampleScaling, Track, TrackIndex};
pub use travel::{Halt, Travel};

/// Fewest usable samples of a scan, or of a pass of it. Fewer do not determine the noise, nor the rates of the reactions.
pub const FEWEST_SAMPLES: usize = 10;
