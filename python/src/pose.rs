//! Poses of the clamp: three numbers.

use crate::array::Floats;
use crate::errors;
use pyo3::prelude::*;
use vibrissa::Pose;

/// A pose from anything with three numbers: x (m), y (m), phi (rad).
pub struct PyPose(pub Pose);

impl<'py> FromPyObject<'py> for PyPose {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let floats: Floats<'_> = object.extract()?;
        let numbers: Vec<f64> = floats.view().iter().copied().collect();
        let [x, y, phi] = numbers[..] else {
            let found = numbers.len();
            return Err(errors::value(format!("a pose has {found} numbers, expected three: x (m), y (m), phi (rad)")));
        };
        Ok(Self(Pose { x, y, phi }))
    }
}

/// A pose as Python sees it.
pub fn tuple(pose: Pose) -> (f64, f64, f64) {
    (pose.x, pose.y, pose.phi)
}
