//! Why a sample gives no reactions.

use super::stage::StageError;
use crate::calibrate::CalibrationError;

/// Why a sample gives no reactions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChainError {
    /// A raw value that is not finite, or another number of channels than the rails have.
    #[error("raw values: {0}")]
    Raw(CalibrationError),
    /// The device has no clock of its own.
    #[error("time: the sample has no time of the device, expected one; take the host's time, or count the samples")]
    NoDeviceTime,
    /// A time that is not finite.
    #[error("time: the {clock} time is {value}, expected a finite number of seconds")]
    Clock {
        /// Whose time.
        clock: &'static str,
        /// Its value.
        value: f64,
    },
    /// The host's time as it is, earlier than before.
    #[error(
        "time: the host's time is {t} s after one of {before} s, expected increasing times; sort the recording, or leave the \
         sample out"
    )]
    HostBackwards {
        /// The time, s.
        t: f64,
        /// The time of the sample before, s.
        before: f64,
    },
    /// No wrench.
    #[error("calibration: {0}")]
    Calibration(CalibrationError),
    /// No pose.
    #[error("stage: {0}")]
    Stage(#[from] StageError),
    /// A wrench that is older than the one before.
    #[error(
        "the wrench at {t} s comes after that at {before} s, expected increasing times; sort the recording, or leave \
         it out"
    )]
    Backwards {
        /// Its time, s.
        t: f64,
        /// The time of the one before, s.
        before: f64,
    },
    /// A wrench that is not finite.
    #[error("the wrench at {t} s is not finite after the {step}, expected finite numbers of N and N m")]
    NotFinite {
        /// Its time, s.
        t: f64,
        /// The step before.
        step: &'static str,
    },
}

/// Why a source gives no reactions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SensorError<E> {
    /// There is no sample.
    #[error(transparent)]
    Source(E),
    /// A sample without a wrench.
    #[error(transparent)]
    Chain(#[from] ChainError),
}
