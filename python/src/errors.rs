//! The library's errors as exceptions with the same texts.

use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use rod_files::SceneError;
use std::ffi::CString;
use std::fmt::Display;
use std::io;
use vibrissa::contact::Stop;

/// An argument that the library refuses: `ValueError`.
pub fn value(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A file that is wrong: `OSError` where it cannot be read, otherwise `ValueError`.
pub fn file(error: SceneError) -> PyErr {
    match error {
        SceneError::Unreadable { ref source, .. } => unreadable(source, &error),
        error => value(error),
    }
}

/// A file that cannot be read: `FileNotFoundError` where it is not there, otherwise `OSError`.
pub fn unreadable(source: &io::Error, error: &impl Display) -> PyErr {
    match source.kind() {
        io::ErrorKind::NotFound => PyFileNotFoundError::new_err(error.to_string()),
        _ => PyOSError::new_err(error.to_string()),
    }
}

/// Warns, as warnings of the category UserWarning.
pub fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)
}

/// `vibrissa.SweepStopped`, with the scan up to there (none for a move of a follower).
pub fn stopped(py: Python<'_>, stop: &Stop, scan: Option<Py<PyAny>>) -> PyErr {
    let pose = (stop.pose.x, stop.pose.y, stop.pose.phi);
    let arguments = (stop.to_string(), stop.reason.to_string(), pose, stop.tau, scan);
    let created = py.import("vibrissa._errors").and_then(|module| module.getattr("SweepStopped")?.call1(arguments));
    created.map_or_else(|error| error, PyErr::from_value)
}
