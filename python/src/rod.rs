//! The rod.

use crate::errors;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use vibrissa::Rod;

/// A straight, uniform, inextensible, linear elastic rod.
///
/// Give ``bending_stiffness``, or ``diameter`` and ``youngs_modulus`` of a round wire.
///
/// Parameters
/// ----------
/// length : float
///     Length in m.
/// bending_stiffness : float, optional
///     Bending stiffness E I in N m^2.
/// diameter : float, optional
///     Diameter of a round wire in m; E I = E pi d^4 / 64.
/// youngs_modulus : float, optional
///     Young's modulus in Pa.
/// yield_stress : float, optional
///     Yield stress in Pa. It is kept for scene files; the rod stays elastic.
///
/// Raises
/// ------
/// ValueError
///     A value is not positive and finite, or the arguments do not go together.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
/// >>> round(rod.bending_stiffness, 6)
/// 0.000632
#[pyclass(frozen, eq, name = "Rod", module = "vibrissa")]
#[derive(Clone, Copy, PartialEq)]
pub struct PyRod {
    pub rod: Rod,
    pub wire: Option<(f64, f64)>,
}

#[pymethods]
impl PyRod {
    #[new]
    #[pyo3(signature = (length, bending_stiffness=None, *, diameter=None, youngs_modulus=None, yield_stress=None))]
    pub fn new(
        length: f64,
        bending_stiffness: Option<f64>,
        diameter: Option<f64>,
        youngs_modulus: Option<f64>,
        yield_stress: Option<f64>,
    ) -> PyResult<Self> {
        let wire = diameter.zip(youngs_modulus);
        let rod = match (bending_stiffness, wire, diameter.is_some() || youngs_modulus.is_some()) {
            (Some(stiffness), None, false) => Rod::new(length, stiffness),
            (None, Some((diameter, modulus)), _) => Rod::from_diameter(length, diameter, modulus),
            _ => return Err(errors::value("expected bending_stiffness, or diameter and youngs_modulus")),
        };
        let rod = match yield_stress {
            Some(stress) => rod.and_then(|rod| rod.with_yield_stress(stress)),
            None => rod,
        };
        Ok(Self { rod: rod.map_err(errors::value)?, wire })
    }

    /// Length in m.
    #[getter]
    fn length(&self) -> f64 {
        self.rod.length()
    }

    /// Bending stiffness E I in N m^2.
    #[getter]
    fn bending_stiffness(&self) -> f64 {
        self.rod.bending_stiffness()
    }

    /// Diameter of the wire in m; None where it is not known.
    #[getter]
    fn diameter(&self) -> Option<f64> {
        self.wire.map(|wire| wire.0)
    }

    /// Young's modulus in Pa; None where it is not known.
    #[getter]
    fn youngs_modulus(&self) -> Option<f64> {
        self.wire.map(|wire| wire.1)
    }

    /// Yield stress in Pa; None where it is not known.
    #[getter]
    fn yield_stress(&self) -> Option<f64> {
        self.rod.yield_stress()
    }

    fn __repr__(&self) -> String {
        let stress = self.yield_stress().map_or_else(String::new, |stress| format!(", yield_stress={stress:?}"));
        let length = self.length();
        match self.wire {
            Some((diameter, modulus)) => {
                format!("Rod({length:?}, diameter={diameter:?}, youngs_modulus={modulus:?}{stress})")
            }
            None => format!("Rod({length:?}, {:?}{stress})", self.bending_stiffness()),
        }
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let stiffness = self.wire.is_none().then(|| self.bending_stiffness());
        let arguments = (self.length(), stiffness, self.diameter(), self.youngs_modulus(), self.yield_stress());
        Ok((py.import("vibrissa._pickled")?.getattr("rod")?, arguments.into_pyobject(py)?))
    }
}
