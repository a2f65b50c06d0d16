//! Poses of the clamp: three numbers.

use crate::array::Floats;
use crate::errors;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::f64::consts::TAU;
use vibrissa::Pose;

/// Angle (rad) beyond which one is warned: two turns. Half a turn is 180 degrees.
const LARGEST: f64 = 2.0 * TAU;

/// A pose from anything with three numbers: x (m), y (m), phi (rad).
pub struct PyPose(pub Pose);

impl<'py> FromPyObject<'py> for PyPose {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let floats: Floats<'_> = object.extract()?;
        let numbers: Vec<f64> = floats.view().iter().copied().collect();
        let [x, y, phi] = numbers[..] else {
            let found = numbers.len();
            let expected = "expected a pose of three numbers: x (m), y (m), phi (rad)";
            return Err(PyTypeError::new_err(format!("{expected}, found {found}")));
        };
        if phi.is_finite() && phi.abs() > LARGEST {
            let text = format!("phi is {phi:?} rad, more than two turns; angles are in rad, not in degrees");
            errors::warn(object.py(), &text)?;
        }
        Ok(Self(Pose { x, y, phi }))
    }
}

/// A pose as Python sees it.
pub fn tuple(pose: Pose) -> (f64, f64, f64) {
    (pose.x, pose.y, pose.phi)
}
