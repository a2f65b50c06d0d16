//! Paths written in Python: functions that give pose and rate.

use crate::errors;
use crate::own_function::OwnFunction;
use crate::path::PyPath;
use crate::pickle::constructor;
use pyo3::prelude::*;
use vibrissa::Pose;
use vibrissa::contact::{Path, PathPoint};
use vibrissa::contour::Range;

/// A function of Python as a path.
struct OwnPath {
    function: OwnFunction<6>,
    length: f64,
}

impl Path for OwnPath {
    fn point(&self, t: f64) -> PathPoint {
        let [x, y, phi, x_rate, y_rate, phi_rate] = self.function.at(t);
        PathPoint { pose: Pose { x, y, phi }, rate: Pose { x: x_rate, y: y_rate, phi: phi_rate } }
    }

    fn length(&self) -> f64 {
        self.length
    }
}

/// A path that a function gives.
///
/// The function is called with arrays of parameters from 0 to ``length``, and with one parameter where the solver needs others. It
/// may slow down and turn back, but not have corners: a path with corners is a :class:`Chain`.
///
/// Parameters
/// ----------
/// function : callable
///     Takes a one-dimensional array of n parameters t, returns an array of shape (6, n): x, y (m), phi (rad) of the clamp, and the
///     derivatives of the three by t.
/// length : float, optional
///     The parameter at the end. The step of a sweep counts in this parameter.
///
/// Raises
/// ------
/// ValueError
///     The function returns something else, or ``length`` is not positive. :func:`sweep` raises it where the rates are not the
///     derivatives of the poses.
///
/// Examples
/// --------
/// >>> import numpy, vibrissa
/// >>> def swing(t):  # to and fro along x
/// ...     x, rate = 0.3 + 0.2 * numpy.cos(t), -0.2 * numpy.sin(t)
/// ...     zero = numpy.zeros_like(t)
/// ...     return [x, zero - 0.4, zero + numpy.pi / 2, rate, zero, zero]
/// >>> path = vibrissa.ClampFunction(swing, 2.0 * numpy.pi)
/// >>> scan = vibrissa.sweep(vibrissa.Rod(1.0, bending_stiffness=1.0), vibrissa.Parabola((0.0, 0.0), 5.0), path, 0.5)
/// >>> scan.phases
/// ['free', 'A', 'B', 'A', 'free']
#[pyclass(frozen, extends = PyPath, name = "ClampFunction", module = "vibrissa")]
pub struct PyClampFunction;

#[pymethods]
impl PyClampFunction {
    #[new]
    #[pyo3(signature = (function, length=1.0))]
    fn new(py: Python<'_>, function: Bound<'_, PyAny>, length: f64) -> PyResult<(Self, PyPath)> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(errors::value(format!("length is {length:?}, expected a finite number greater than 0")));
        }
        let range = Range { from: 0.0, to: length };
        let constructor = constructor!(py, "ClampFunction", function, length);
        let function = OwnFunction::new(function, range, "the function", "(6, n)")?;
        Ok((Self, PyPath::new(OwnPath { function, length }, None, Some(constructor))))
    }
}
