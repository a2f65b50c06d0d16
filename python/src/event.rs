//! Transitions between phases.

use crate::array::{Column, Get};
use crate::errors;
use crate::pickle::Reduced;
use crate::pose::tuple;
use crate::state::PyState;
use pyo3::prelude::*;
use vibrissa::Event;

/// Columns of an event: those of the command's `events.jsonl`.
pub const EVENT: &[Column<Event>] = &[
    Column { name: "kind", get: Get::Text(|event| event.kind.to_string().into()) },
    Column { name: "from", get: Get::Text(|event| event.from().to_string().into()) },
    Column { name: "to", get: Get::Text(|event| event.to().to_string().into()) },
    Column { name: "x0", get: Get::Float(|event| event.before.pose.x) },
    Column { name: "y0", get: Get::Float(|event| event.before.pose.y) },
    Column { name: "phi0", get: Get::Float(|event| event.before.pose.phi) },
    Column { name: "f0x", get: Get::Float(|event| event.before.reactions.f0x) },
    Column { name: "f0y", get: Get::Float(|event| event.before.reactions.f0y) },
    Column { name: "m0z", get: Get::Float(|event| event.before.reactions.m0z) },
    Column { name: "x0_after", get: Get::Float(|event| event.after.pose.x) },
    Column { name: "y0_after", get: Get::Float(|event| event.after.pose.y) },
    Column { name: "phi0_after", get: Get::Float(|event| event.after.pose.phi) },
    Column { name: "f0x_after", get: Get::Float(|event| event.after.reactions.f0x) },
    Column { name: "f0y_after", get: Get::Float(|event| event.after.reactions.f0y) },
    Column { name: "m0z_after", get: Get::Float(|event| event.after.reactions.m0z) },
    Column { name: "leg", get: Get::Int(|event| event.leg() as i64) },
    Column { name: "dissipated", get: Get::Float(|event| event.dissipated.unwrap_or(f64::NAN)) },
];

/// A transition between two phases.
#[pyclass(frozen, eq, name = "Event", module = "vibrissa")]
#[derive(Clone, PartialEq)]
pub struct PyEvent {
    pub event: Event,
}

#[pymethods]
impl PyEvent {
    /// What happened: "first-contact", "touch", "release", "tip-to-tangent", "tangent-to-tip", "piece", "slip-over", "stick",
    /// "slip", "snap" or "snap-off".
    #[getter]
    fn kind(&self) -> String {
        self.event.kind.to_string()
    }

    /// Pose of the clamp: x (m), y (m), phi (rad).
    #[getter]
    fn pose(&self) -> (f64, f64, f64) {
        tuple(self.event.pose())
    }

    /// The last state before.
    #[getter]
    fn before(&self) -> PyState {
        PyState { state: self.event.before.clone() }
    }

    /// The first state after; after a snap whose new branch begins only there its pose may be up to 0.05 rod lengths further along the path.
    #[getter]
    fn after(&self) -> PyState {
        PyState { state: self.event.after.clone() }
    }

    /// The energy (J) lost since the sweep began by friction and jumps, that of this event included; None without friction.
    #[getter]
    fn dissipated(&self) -> Option<f64> {
        self.event.dissipated
    }

    /// An event from what pickling keeps of it.
    #[staticmethod]
    fn _from_json(text: &str) -> PyResult<Self> {
        Ok(Self { event: serde_json::from_str(text).map_err(errors::value)? })
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let text = serde_json::to_string(&self.event).map_err(errors::value)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (text,).into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        let ((x, y, phi), event) = (self.pose(), &self.event);
        format!("<vibrissa.Event {}: {} to {} at clamp ({x:?}, {y:?}, {phi:?})>", event.kind, event.from(), event.to())
    }
}
