//! Derivatives of equilibria and of transitions.

use crate::array::{Column, Floats, Get, structured, whole};
use crate::composite::{self, contours};
use crate::event::PyEvent;
use crate::rod::PyRod;
use crate::state::PyState;
use crate::{errors, running};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use vibrissa::contact::{ContactError, Derivatives, Quantity, TransitionDerivatives};
use vibrissa::rod::{AnyRod, ContactRate, RodParameter};
use vibrissa::{Composite, Pose};

const RATE: &[Column<ContactRate>] = &[
    Column { name: "x", get: Get::Float(|rate| rate.x) },
    Column { name: "y", get: Get::Float(|rate| rate.y) },
    Column { name: "alpha", get: Get::Float(|rate| rate.alpha) },
    Column { name: "phi", get: Get::Float(|rate| rate.phi) },
    Column { name: "s", get: Get::Float(|rate| rate.s) },
    Column { name: "force", get: Get::Float(|rate| rate.force) },
];

/// Exact derivatives of one equilibrium, by the implicit function theorem.
///
/// The contacts stay as they are: at a transition these are the derivatives on the side of the state.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches.
/// state : State
///     An equilibrium of this rod on these objects.
///
/// Raises
/// ------
/// ValueError
///     The state is none of this rod on these objects, or is at a fold, where derivatives are infinite.
#[pyclass(frozen, name = "Derivatives", module = "vibrissa")]
pub struct PyDerivatives {
    rod: AnyRod,
    objects: Vec<Composite>,
    state: PyState,
    condition: f64,
}

impl PyDerivatives {
    /// Computes something of the derivatives, which borrow from objects and state.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&Derivatives<'_>) -> Result<T, ContactError> + Send,
    ) -> PyResult<T> {
        let Self { rod, objects, state, .. } = self;
        let found = || ask(&Derivatives::new(rod, &objects[..], &state.state)?);
        running::run(py, found)?.map_err(errors::value)
    }
}

/// What one may differentiate by.
enum By<'a> {
    Quantity(Quantity<'a>),
    Rod(RodParameter),
}

/// The quantity or the parameter of the rod of that name.
fn quantity_or_parameter<'a>(
    quantity: &str,
    [object, piece, section]: [usize; 3],
    parameter: Option<&'a str>,
) -> PyResult<By<'a>> {
    let of_rod = match quantity {
        "taper" => Some(RodParameter::Taper),
        "natural_curvature" => Some(RodParameter::NaturalCurvature),
        "section_stiffness" => Some(RodParameter::SectionStiffness(section)),
        "section_curvature" => Some(RodParameter::SectionCurvature(section)),
        _ => None,
    };
    if let Some(of_rod) = of_rod.filter(|_| parameter.is_none()) {
        return Ok(By::Rod(of_rod));
    }
    Ok(By::Quantity(match (quantity, parameter) {
        ("clamp_x", None) => Quantity::ClampX,
        ("clamp_y", None) => Quantity::ClampY,
        ("clamp_angle", None) => Quantity::ClampAngle,
        ("stiffness", None) => Quantity::Stiffness,
        ("length", None) => Quantity::Length,
        ("clamp_stiffness_x", None) => Quantity::ClampStiffnessX,
        ("clamp_stiffness_y", None) => Quantity::ClampStiffnessY,
        ("clamp_stiffness_phi", None) => Quantity::ClampStiffnessPhi,
        ("object_x", None) => Quantity::ObjectX(object),
        ("object_y", None) => Quantity::ObjectY(object),
        ("object_angle", None) => Quantity::ObjectAngle(object),
        ("object_scale", None) => Quantity::ObjectScale(object),
        ("shape", Some(parameter)) => Quantity::Shape { object, piece, parameter },
        ("shape", None) => return Err(errors::value("quantity is \"shape\", expected a parameter beside it")),
        _ => {
            return Err(errors::value(format!(
                "quantity is {quantity:?}, expected \"clamp_x\", \"clamp_y\", \"clamp_angle\", \"stiffness\", \"length\", \
                 \"taper\", \"natural_curvature\", \"section_stiffness\", \"section_curvature\", \"clamp_stiffness_x\", \
                 \"clamp_stiffness_y\", \"clamp_stiffness_phi\", \"object_x\", \"object_y\", \"object_angle\", \"object_scale\", or \
                 \"shape\" with a parameter"
            )));
        }
    }))
}

#[pymethods]
impl PyDerivatives {
    #[new]
    fn new(py: Python<'_>, rod: &PyRod, objects: &Bound<'_, PyAny>, state: &PyState) -> PyResult<Self> {
        let objects = contours(&composite::objects(objects)?);
        let created = Self { rod: rod.rod.clone(), objects, state: state.clone(), condition: f64::NAN };
        let condition = created.ask(py, |derivatives| Ok(derivatives.condition()))?;
        Ok(Self { condition, ..created })
    }

    /// Condition number of the equations; it grows towards a fold.
    #[getter]
    fn condition(&self) -> f64 {
        self.condition
    }

    /// The stiffness of the clamp.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape (3, 3): rows f0x, f0y (N), m0z (N m), columns x0, y0 (m), phi0 (rad). It is symmetric.
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let matrix = self.ask(py, |derivatives| derivatives.stiffness())?;
        let rows: Vec<Vec<f64>> = matrix.iter().map(|row| row.to_vec()).collect();
        PyArray2::from_vec2(py, &rows).map_err(errors::value)
    }

    /// The change of reactions and contacts per unit of one quantity.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     ``"clamp_x"``, ``"clamp_y"`` (m), ``"clamp_angle"`` (rad), ``"stiffness"`` (N m^2), ``"length"`` (m), ``"object_x"``,
    ///     ``"object_y"`` (m), ``"object_angle"`` (rad, about the origin), ``"object_scale"`` (a factor of its coordinates), or
    ///     ``"shape"``: a parameter of a shape. Of the rod: ``"taper"`` (1 - tip / base diameter), ``"natural_curvature"`` (1/m, added all
    ///     along), ``"section_stiffness"`` (N m^2), ``"section_curvature"`` (1/m). Of its clamp: ``"clamp_stiffness_x"``,
    ///     ``"clamp_stiffness_y"`` (N/m), ``"clamp_stiffness_phi"`` (N m/rad).
    /// object, piece, section : int, optional
    ///     Number of the object and of its piece, or of the section of the rod, from 0.
    /// parameter : str, optional
    ///     The parameter of the shape, such as ``"coefficient"`` of a parabola.
    ///
    /// Returns
    /// -------
    /// reactions : numpy.ndarray
    ///     Changes of f0x, f0y (N) and m0z (N m) per unit.
    /// contacts : numpy.ndarray
    ///     Structured, one row for each contact: changes of x, y (m), alpha, phi (rad), s (m) and force (N) per unit.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     There is no such quantity, object, piece or parameter.
    #[pyo3(signature = (quantity, *, object=0, piece=0, section=0, parameter=None))]
    fn by<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        #[pyo3(from_py_with = whole)] object: usize,
        #[pyo3(from_py_with = whole)] piece: usize,
        #[pyo3(from_py_with = whole)] section: usize,
        parameter: Option<&str>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyAny>)> {
        let response = match quantity_or_parameter(quantity, [object, piece, section], parameter)? {
            By::Quantity(quantity) => self.ask(py, |derivatives| derivatives.by(quantity))?,
            By::Rod(parameter) => {
                let Self { rod, objects, state, .. } = self;
                let by = || Derivatives::new(rod, &objects[..], &state.state)?.by_rod(rod, parameter);
                running::run(py, by)?.map_err(errors::value)?
            }
        };
        let reactions = response.reactions;
        let reactions = PyArray1::from_slice(py, &[reactions.f0x, reactions.f0y, reactions.m0z]);
        Ok((reactions, structured(py, RATE, response.contacts.iter())?))
    }
}

/// Exact derivatives of the pose at which a transition happens, by the implicit function theorem.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches.
/// event : Event
///     A transition of a sweep of this rod past these objects; a fold that ends in a snap is one too.
/// rate : array_like
///     How the clamp moves there: the derivatives of x (m), y (m) and phi (rad) by the parameter of its path, as
///     :meth:`Path.rate` gives them.
///
/// Raises
/// ------
/// ValueError
///     The event is none of this rod on these objects, or no one equation defines its pose.
#[pyclass(frozen, name = "TransitionDerivatives", module = "vibrissa")]
pub struct PyTransitionDerivatives {
    rod: AnyRod,
    objects: Vec<Composite>,
    event: PyEvent,
    rate: Pose,
}

impl PyTransitionDerivatives {
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&TransitionDerivatives<'_>) -> Result<T, ContactError> + Send,
    ) -> PyResult<T> {
        let Self { rod, objects, event, rate } = self;
        let found = || ask(&TransitionDerivatives::new(rod, &objects[..], &event.event, *rate)?);
        running::run(py, found)?.map_err(errors::value)
    }
}

#[pymethods]
impl PyTransitionDerivatives {
    #[new]
    fn new(
        py: Python<'_>,
        rod: &PyRod,
        objects: &Bound<'_, PyAny>,
        event: &PyEvent,
        rate: Floats<'_>,
    ) -> PyResult<Self> {
        let objects = contours(&composite::objects(objects)?);
        let rate: Vec<f64> = rate.view().iter().copied().collect();
        let &[x, y, phi] = &rate[..] else {
            return Err(errors::value(format!("rate has {} numbers, expected three: x, y, phi", rate.len())));
        };
        let created = Self { rod: rod.rod.clone(), objects, event: event.clone(), rate: Pose { x, y, phi } };
        created.ask(py, |_| Ok(()))?;
        Ok(created)
    }

    /// The change of the path's parameter at the transition per unit of one quantity.
    ///
    /// Parameters
    /// ----------
    /// quantity, object, piece, section, parameter
    ///     As for :meth:`Derivatives.by`.
    ///
    /// Returns
    /// -------
    /// float
    ///     m (or rad, where the clamp only turns) per unit. The path stays as it is, or is moved as a whole by a quantity of the clamp.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     There is no such quantity, object, piece or parameter.
    #[pyo3(signature = (quantity, *, object=0, piece=0, section=0, parameter=None))]
    fn by(
        &self,
        py: Python<'_>,
        quantity: &str,
        #[pyo3(from_py_with = whole)] object: usize,
        #[pyo3(from_py_with = whole)] piece: usize,
        #[pyo3(from_py_with = whole)] section: usize,
        parameter: Option<&str>,
    ) -> PyResult<f64> {
        match quantity_or_parameter(quantity, [object, piece, section], parameter)? {
            By::Quantity(quantity) => self.ask(py, |derivatives| derivatives.by(quantity)),
            By::Rod(parameter) => {
                let Self { rod, objects, event, rate } = self;
                let by = || TransitionDerivatives::new(rod, &objects[..], &event.event, *rate)?.by_rod(rod, parameter);
                running::run(py, by)?.map_err(errors::value)
            }
        }
    }
}
