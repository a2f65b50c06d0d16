//! Calibration: from raw values to a wrench; the tare.

mod accuracy;
#[cfg(feature = "cal")]
mod ati;
mod error;
mod gauge_matrix;
mod rated_load;
mod scale;
mod sensor_check;
mod tare;
mod wrench_units;

pub use accuracy::Accuracy;
#[cfg(feature = "cal")]
pub use ati::{AtiCalibration, AtiFile, AtiFileError};
pub use error::CalibrationDataError;
pub use gauge_matrix::{Compensation, GaugeMatrix};
pub use rated_load::RatedLoad;
pub use scale::Scale;
pub use sensor_check::{SensorCheck, SensorFinding};
pub use tare::{Tare, TareError, TareLimits, TareWindow, Zero};
pub use wrench_units::WrenchUnits;

use crate::sample::{Component, Number, RawSample, Wrench, WrenchSample};

/// From raw values to force and torque at the sensor's origin.
///
/// For sensor authors: one method; a closure is a calibration, too.
///
/// ```
/// use rod_hw::{Calibration, CalibrationError, Channels, RawSample, Wrench, WrenchSample};
/// // a base of three Hall sensors with a law of its own
/// let calibration = |raw: &RawSample| -> Result<WrenchSample, CalibrationError> {
///     let torque = [0.0, 0.0, 1e-3 * raw.channels[0].tanh()];
///     Ok(WrenchSample::of(raw, Wrench { force: [0.0; 3], torque }))
/// };
/// let found = calibration.wrench(&RawSample::new(0.0, Channels::from([0.5, 0.0, 0.0])))?;
/// assert_eq!(found.wrench.torque[2], 1e-3 * 0.5_f64.tanh());
/// # Ok::<(), CalibrationError>(())
/// ```
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
    /// A temperature that the compensation is not for.
    #[error(
        "a temperature of {temperature} gives gauge {gauge} a gain of 1 / {divisor}, expected a positive one; check thermometer \
         and gain slopes"
    )]
    Temperature {
        /// Which gauge, from 1.
        gauge: usize,
        /// The temperature, as the device tells it.
        temperature: f64,
        /// One over the gain.
        divisor: f64,
    },
    /// The raw values are numbers, but no wrench.
    #[error("{component} is {value} {} after calibration, expected a finite number; check the factors of the calibration", .component.si())]
    Overflow {
        /// Which component.
        component: Component,
        /// Its value.
        value: f64,
    },
}

/// Refuses a sample of another number of channels.
pub(crate) fn expect_channels(raw: &RawSample, expected: usize) -> Result<(), CalibrationError> {
    let found = raw.channels.len();
    if found == expected { Ok(()) } else { Err(CalibrationError::Channels { found, expected }) }
}

/// A channel, from 0, if it is a number.
pub(crate) fn finite_channel(raw: &RawSample, channel: usize) -> Result<f64, CalibrationError> {
    let value = raw.channels.get(channel).copied().unwrap_or(f64::NAN);
    if value.is_finite() { Ok(value) } else { Err(CalibrationError::NotFinite { channel: channel + 1, value }) }
}

/// The sample of these components, if they are numbers.
fn finished<T: Number>(raw: &RawSample, components: [T; 6]) -> Result<WrenchSample<T>, CalibrationError> {
    let wrench = Wrench::from_components(components);
    match Component::ALL.iter().find(|c| !c.of(&wrench).to_f64().is_finite()) {
        Some(&component) => Err(CalibrationError::Overflow { component, value: component.of(&wrench).to_f64() }),
        None => Ok(WrenchSample::of(raw, wrench)),
    }
}

/// A closure of the raw sample is a calibration.
impl<T, F: Fn(&RawSample) -> Result<WrenchSample<T>, CalibrationError>> Calibration<T> for F {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        self(raw)
    }
}
