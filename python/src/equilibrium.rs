//! Equilibrium at one pose for given contacts.

use crate::composite::{self, contours};
use crate::pose::PyPose;
use crate::rod::PyRod;
use crate::state::{PyContact, PyState};
use crate::{errors, running};
use pyo3::prelude::*;
use vibrissa::contact::Contact;

/// What a solve for given contacts came to.
///
/// Attributes
/// ----------
/// state : State
///     The state; where it is not solved, only where the solve came to.
/// solved : bool
///     Whether the equations are solved.
/// problem : str or None
///     Why the rod cannot be in this state, and what to try; None if it can be.
/// iterations : int
///     Number of Newton steps.
#[pyclass(frozen, get_all, name = "Equilibrium", module = "vibrissa")]
pub struct PyEquilibrium {
    /// The state; where it is not solved, only where the solve came to.
    state: PyState,
    /// Whether the equations are solved.
    solved: bool,
    /// Why the rod cannot be in this state, and what to try; None if it can be.
    problem: Option<String>,
    /// Number of Newton steps.
    iterations: u32,
}

#[pymethods]
impl PyEquilibrium {
    fn __repr__(&self) -> String {
        let phase = self.state.state.phase();
        format!("<vibrissa.Equilibrium {phase}: {}>", self.problem.as_deref().unwrap_or("admissible"))
    }
}

/// The equilibrium at one pose, held by exactly the contacts that are given.
///
/// Of each contact its object, piece and kind are kept; the rest is where the solve starts. Nothing is added to the contacts or taken
/// from them; that is what :func:`sweep` does.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches.
/// pose : tuple of float
///     The clamp: x (m), y (m), phi (rad).
/// guess : sequence of Contact
///     The contacts from the clamp to the tip.
///
/// Returns
/// -------
/// Equilibrium
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, or a contact cannot be where it is said to be.
#[pyfunction]
pub fn equilibrium(
    py: Python<'_>,
    rod: &PyRod,
    objects: &Bound<'_, PyAny>,
    pose: PyPose,
    guess: Vec<Bound<'_, PyContact>>,
) -> PyResult<PyEquilibrium> {
    let objects = contours(&composite::objects(objects)?);
    let guess: Vec<Contact> = guess.iter().map(|contact| contact.get().contact()).collect::<PyResult<_>>()?;
    let solve = || vibrissa::equilibrium(&rod.rod, &objects[..], pose.0, &guess);
    let found = running::run(py, solve)?;
    let found = found.map_err(errors::value)?;
    let (solved, iterations) = (found.report.status.is_solved(), found.report.iterations);
    let problem = found.is_admissible().err().map(|problem| problem.to_string());
    Ok(PyEquilibrium { state: PyState { state: found.state }, solved, problem, iterations })
}
