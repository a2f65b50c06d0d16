//! Why a calibration file of ATI cannot be used.

use crate::calibrate::CalibrationDataError;
use crate::sample::Component;
use std::path::PathBuf;

/// Why a calibration file of ATI cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtiFileError {
    /// In this file.
    #[error("{}: {error}", .file.display())]
    In {
        /// The file.
        file: PathBuf,
        /// The fault.
        error: Box<Self>,
    },
    /// It cannot be read, or is no text.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// The message of the operating system.
        message: String,
    },
    /// It is no XML.
    #[error("line {line}: {message}; is it a .cal file of ATI, and whole?")]
    Malformed {
        /// Where.
        line: u32,
        /// The fault.
        message: String,
    },
    /// An element is another, or is not there.
    #[error("line {line}: {found}, expected {expected}")]
    Element {
        /// Where.
        line: u32,
        /// The bytes found there.
        found: String,
        /// The expected text.
        expected: &'static str,
    },
    /// An attribute is missing or no value of its kind.
    #[error(
        "line {line}: `{attribute}` of `{element}` is {}, expected {expected}",
        .value.as_ref().map_or("missing".to_owned(), |value| format!("`{value}`"))
    )]
    Attribute {
        /// Where.
        line: u32,
        /// The element.
        element: String,
        /// Which attribute.
        attribute: &'static str,
        /// Its value, if it is there.
        value: Option<String>,
        /// The expected value.
        expected: String,
    },
    /// The numbers are no calibration.
    #[error("line {line}: {error}")]
    Data {
        /// Where the calibration begins.
        line: u32,
        /// The fault.
        error: CalibrationDataError,
    },
    /// The two matrices of the file are not the same.
    #[error(
        "line {line}: `UserAxis` {component} of gauge {gauge} is {found}, but `Axis`, `scale` and `BasicTransform` make it \
         {expected}; the file is damaged or was changed by hand: ask ATI for that of the sensor's serial number"
    )]
    UserAxis {
        /// Where.
        line: u32,
        /// Which row.
        component: Component,
        /// Which column, from 1.
        gauge: usize,
        /// The value in the file.
        found: f64,
        /// The value that follows from the rest of the file.
        expected: f64,
    },
    /// There are several calibrations, or none of this part number.
    #[error("the file has calibrations of the part numbers {found}, expected {}", .part.as_ref().map_or(
        "one of them by its part number".to_owned(), |part| format!("`{part}`")))]
    Part {
        /// The requested part number.
        part: Option<String>,
        /// Which ones there are.
        found: String,
    },
    /// The sensor has another number of gauges.
    #[error("the sensor has {found} gauges, expected {expected}")]
    Gauges {
        /// How many it has.
        found: usize,
        /// The requested number.
        expected: usize,
    },
}
