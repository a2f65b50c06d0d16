//! From raw values to a wrench.

use crate::raw::RawSample;
use crate::wrench_sample::WrenchSample;

/// From raw values to force and torque at the sensor's origin.
///
/// For sensor authors: one method; a sensor that is not linear is a closure in an [`FnCalibration`].
pub trait Calibration<T = f64> {
    /// The wrench, with time, status and quality of the raw sample ([`WrenchSample::of`]), and what is known of its
    /// errors.
    ///
    /// # Errors
    /// [`CalibrationError`] where the values cannot be converted; never a value that is not finite.
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError>;
}

/// Why raw values give no wrench.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The device sends another number of channels.
    #[error("the sample has {found} channels, expected {expected}; check the channels of the calibration")]
    Channels {
        /// How many the sample has.
        found: usize,
        /// How many the calibration is for.
        expected: usize,
    },
    /// A raw value is no number.
    #[error("channel {channel} is {value}, expected a finite number")]
    NotFinite {
        /// Which one, from 1.
        channel: usize,
        /// Its value.
        value: f64,
    },
    /// The calibration compensates for a temperature that the device does not tell.
    #[error("the sample has no temperature, which this calibration needs; expected one with every sample")]
    NoTemperature,
}

/// A closure as a calibration.
///
/// ```
/// use rod_hw::{Calibration, Channels, FnCalibration, RawSample, Wrench, WrenchSample};
/// // a base of three Hall sensors with a law of its own
/// let calibration = FnCalibration(|raw: &RawSample| {
///     let torque = [0.0, 0.0, 1e-3 * raw.channels[0].tanh()];
///     Ok(WrenchSample::<f64>::of(raw, Wrench { force: [0.0; 3], torque }))
/// });
/// let found = calibration.wrench(&RawSample::new(0.0, Channels::from([0.5, 0.0, 0.0])))?;
/// assert_eq!(found.wrench.torque[2], 1e-3 * 0.5_f64.tanh());
/// # Ok::<(), rod_hw::CalibrationError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FnCalibration<F>(pub F);

impl<T, F: Fn(&RawSample) -> Result<WrenchSample<T>, CalibrationError>> Calibration<T> for FnCalibration<F> {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        (self.0)(raw)
    }
}

impl<T, C: Calibration<T> + ?Sized> Calibration<T> for &C {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        (**self).wrench(raw)
    }
}

#[cfg(feature = "std")]
impl<T, C: Calibration<T> + ?Sized> Calibration<T> for Box<C> {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        (**self).wrench(raw)
    }
}
