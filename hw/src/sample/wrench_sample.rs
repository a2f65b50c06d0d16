//! Wrenches at the sensor.

use super::number::Number;
use super::quality::Quality;
use super::raw::RawSample;
use super::wrench::Wrench;

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
