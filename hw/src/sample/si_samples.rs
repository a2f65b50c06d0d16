//! Samples in SI units: wrenches at the sensor, reactions at the clamp.

use super::quality::Quality;
use super::raw::RawSample;
use super::wrench::{Number, Wrench};
use rod_core::{Pose, Reactions, Sample};

/// Force and torque on the sensor, about its origin, in its axes, at one instant.
///
/// ```
/// use rod_hw::{Wrench, WrenchSample};
/// let sample = WrenchSample::new(0.1, Wrench { force: [0.2, 0.0, 0.0], torque: [0.0; 3] });
/// assert!(sample.sigma.is_none() && sample.quality.is_empty());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WrenchSample<T = f64> {
    /// Time, s.
    pub t: f64,
    /// N and N m.
    pub wrench: Wrench<T>,
    /// Standard deviations of the random error, N and N m, where they are known.
    pub sigma: Option<Wrench<T>>,
    /// Bounds of the systematic error (gain, linearity, crosstalk, hysteresis), N and N m, where they are known.
    pub systematic: Option<Wrench<T>>,
    /// Quality flags.
    pub quality: Quality,
    /// The raw sample.
    pub raw: RawSample,
}

impl<T: Number> WrenchSample<T> {
    /// A wrench at a time (s), of which nothing else is known.
    pub fn new(t: f64, wrench: Wrench<T>) -> Self {
        let raw = RawSample { host_time: t, ..RawSample::default() };
        Self { t, wrench, sigma: None, systematic: None, quality: Quality::default(), raw }
    }

    /// The wrench of a raw sample, with its time and quality.
    pub fn of(raw: &RawSample, wrench: Wrench<T>) -> Self {
        Self { quality: raw.quality, raw: *raw, ..Self::new(raw.time(), wrench) }
    }
}

/// Clamp pose and reactions at one instant, as the reconstruction takes them, and how far they can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReactionSample<T = f64> {
    /// Time, s.
    pub t: f64,
    /// The clamp: m, m, rad.
    pub pose: Pose<T>,
    /// Reactions of the clamp on the rod, N, N, N m about the clamp.
    pub reactions: Reactions<T>,
    /// Standard deviations of the random error, where they are known.
    pub sigma: Option<Reactions<T>>,
    /// Bounds of the systematic error, where they are known.
    pub systematic: Option<Reactions<T>>,
    /// Components that a planar rod cannot cause.
    pub out_of_plane: OutOfPlane<T>,
    /// Quality flags.
    pub quality: Quality,
    /// The raw sample.
    pub raw: RawSample,
}

/// The components that a rod bent in the plane does not cause, in the axes of the scene, about the clamp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutOfPlane<T = f64> {
    /// Force across the plane, N.
    pub f0z: T,
    /// Moment about x, N m.
    pub m0x: T,
    /// Moment about y, N m.
    pub m0y: T,
}

impl ReactionSample {
    /// For the reconstruction.
    pub fn sample(&self) -> Sample {
        Sample { t: Some(self.t), pose: self.pose, reactions: self.reactions, sigma: self.sigma }
    }
}
