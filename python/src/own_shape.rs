//! Shapes written in Python: objects with a method `frame`.

use crate::array::two;
use crate::own_function::OwnFunction;
use crate::shape::PyShape;
use crate::{errors, running};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::fmt;
use std::sync::Arc;
use vibrissa::Contour;
use vibrissa::contour::{ContourError, Frame, Range, contract};

/// An object of Python as a contour.
#[derive(Clone)]
pub struct OwnShape {
    frame: Arc<OwnFunction<5>>,
    range: Range,
}

impl OwnShape {
    pub fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let range = match object.getattr_opt("range")? {
            Some(range) => {
                let named =
                    |error: PyErr| PyTypeError::new_err(format!("range of the shape: {}", error.value(object.py())));
                let [from, to] = two(&range).map_err(named)?;
                Range { from, to }
            }
            None => Range::UNIT,
        };
        let Range { from, to } = range;
        if from.is_nan() || to.is_nan() || from >= to {
            return Err(errors::value(ContourError::EmptyRange { what: "the range of the shape", from, to }));
        }
        let frame = OwnFunction::new(object.getattr("frame")?, range, "frame(t)", "(5, n)")?;
        Ok(Self { frame: Arc::new(frame), range })
    }
}

impl Contour for OwnShape {
    fn frame(&self, t: f64) -> Frame {
        let [x, y, alpha, speed, turning] = self.frame.at(t);
        Frame { x, y, alpha, speed, turning }
    }

    fn range(&self) -> Range {
        self.range
    }
}

impl fmt::Debug for OwnShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnShape").field("range", &self.range).finish_non_exhaustive()
    }
}

/// A shape of the library, or an object of Python that has a frame.
pub fn shape<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyShape>> {
    if let Ok(shape) = object.downcast::<PyShape>() {
        return Ok(shape.clone());
    }
    if object.hasattr("frame")? {
        let own = OwnShape::new(object)?;
        return Bound::new(object.py(), PyShape::single(own, None, None));
    }
    let found = object.get_type().name()?;
    Err(pyo3::exceptions::PyTypeError::new_err(format!(
        "the shape is of type {found}, expected a vibrissa.Shape or an object with a method frame(t); points make a Polygon or a Spline"
    )))
}

/// Test a shape against the contract of shapes.
///
/// A shape of your own is any object with a method ``frame(t)``. It takes a one-dimensional array of n parameters, and
/// returns an array of shape (5, n): x (m), y (m), tangent angle alpha (rad), speed (m per unit of t) and turning (rad per unit
/// of t), with ``dr/dt = speed (cos alpha, sin alpha)`` and ``d alpha/dt = turning``. The solid is on the left. alpha does not
/// jump, and ``frame`` goes on smoothly a little beyond the range. An attribute ``range`` gives the ends of t; without it
/// they are 0 and 1. ``docs/add-a-shape.md`` has the contract in full.
///
/// Parameters
/// ----------
/// shape : Shape or object with ``frame``
///     What to test.
/// samples : sequence of float, optional
///     Where, as fractions of the range from 0 to 1; by default 21 of them.
///
/// Raises
/// ------
/// ValueError
///     The line of the contract that the shape breaks, where, and by how much.
#[pyfunction]
#[pyo3(signature = (shape, samples=None))]
pub fn check_contract(py: Python<'_>, shape: &Bound<'_, PyAny>, samples: Option<Vec<f64>>) -> PyResult<()> {
    let shape = self::shape(shape)?;
    let samples = samples.unwrap_or_else(|| (0..=20).map(|k| f64::from(k) / 20.0).collect());
    let shape = shape.get();
    running::run(py, || contract::check(shape.contour(), &samples))?.map_err(errors::value)
}
