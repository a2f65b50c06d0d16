//! A rod that is moved from pose to pose.

use crate::composite::{self, contours};
use crate::event::PyEvent;
use crate::friction::Given;
use crate::pose::PyPose;
use crate::rod::PyRod;
use crate::state::PyState;
use crate::{errors, running};
use pyo3::prelude::*;
use rod_files::SceneFriction;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use vibrissa::contact::Item;
use vibrissa::rod::AnyRod;
use vibrissa::{Composite, Follower};

/// A rod in equilibrium whose clamp is moved from pose to pose, for controllers.
///
/// Each move follows the equilibria through all transitions, as a sweep does. To try a move, make it with a :meth:`clone`.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches.
/// pose : tuple of float
///     First pose of the clamp: x (m), y (m), phi (rad). In contact there, the rod has the shape that it gets when it is pushed
///     forward along its own axis.
/// friction : float, tuple of float, or list, optional
///     Coulomb friction, as in :func:`vibrissa.sweep`. In contact at the first pose, the rod has none until it moves.
///
/// Raises
/// ------
/// ValueError
///     The friction is not possible.
/// SweepStopped
///     There is no equilibrium at that pose.
///
/// Examples
/// --------
/// >>> import math, vibrissa
/// >>> rod, object = vibrissa.Rod(1.0, 1.0), vibrissa.Parabola((0.0, 0.0), 5.0)
/// >>> follower = vibrissa.Follower(rod, object, (0.5, -0.4, math.pi / 2))
/// >>> [item.kind for item in follower.to((0.2, -0.4, math.pi / 2)) if isinstance(item, vibrissa.Event)]
/// ['first-contact']
/// >>> follower.state.phase
/// 'A'
#[pyclass(frozen, name = "Follower", module = "vibrissa")]
pub struct PyFollower {
    /// It borrows from `objects`, hence stands before them: fields are dropped in order.
    follower: Mutex<Follower<'static, AnyRod>>,
    objects: Arc<[Composite]>,
}

/// The objects for a follower that is dropped before they are.
#[expect(unsafe_code, reason = "a class of Python has no lifetime; the follower is kept beside what it borrows")]
fn borrow_objects(objects: &Arc<[Composite]>) -> &'static [Composite] {
    // Sound, because the slice lives on the heap, is never written to, and `PyFollower` drops its follower first.
    unsafe { &*Arc::as_ptr(objects) }
}

fn rubbing(
    follower: Follower<'static, AnyRod>,
    friction: Option<SceneFriction>,
) -> PyResult<Follower<'static, AnyRod>> {
    match friction {
        Some(friction) => follower.with_friction(friction).map_err(errors::value),
        None => Ok(follower),
    }
}

impl PyFollower {
    /// To be called without the interpreter: whoever has the lock may be waiting for it, in a shape of Python.
    fn lock_follower(&self) -> MutexGuard<'_, Follower<'static, AnyRod>> {
        self.follower.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PyFollower {
    #[new]
    #[pyo3(signature = (rod, objects, pose, *, friction=None))]
    fn new(
        py: Python<'_>,
        rod: &PyRod,
        objects: &Bound<'_, PyAny>,
        pose: PyPose,
        friction: Option<Given>,
    ) -> PyResult<Self> {
        let objects: Arc<[Composite]> = contours(&composite::objects(objects)?).into();
        let friction = friction.map(|given| given.of(&objects)).transpose()?.flatten();
        let make = || Follower::new(&rod.rod, borrow_objects(&objects), pose.0);
        let created = running::run(py, make)?.map_err(|stop| errors::stopped(py, &stop, None))?;
        Ok(Self { follower: Mutex::new(rubbing(created, friction)?), objects })
    }

    /// A rod in an equilibrium that is known.
    ///
    /// Parameters
    /// ----------
    /// rod : Rod
    ///     The rod.
    /// objects : Composite, Shape, object with ``frame``, or sequence of these
    ///     What the rod touches.
    /// state : State
    ///     A state of this rod on these objects.
    /// friction : float, tuple of float, or list, optional
    ///     Coulomb friction, as in :func:`vibrissa.sweep`; contacts that stick in the state go on sticking.
    ///
    /// Returns
    /// -------
    /// Follower
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     The state is none of this rod on these objects.
    #[staticmethod]
    #[pyo3(signature = (rod, objects, state, *, friction=None))]
    fn from_state(
        py: Python<'_>,
        rod: &PyRod,
        objects: &Bound<'_, PyAny>,
        state: &PyState,
        friction: Option<Given>,
    ) -> PyResult<Self> {
        let objects: Arc<[Composite]> = contours(&composite::objects(objects)?).into();
        let friction = friction.map(|given| given.of(&objects)).transpose()?.flatten();
        let state = &state.state;
        let make = || Follower::from_state(&rod.rod, borrow_objects(&objects), state);
        let created = running::run(py, make)?;
        Ok(Self { follower: Mutex::new(rubbing(created.map_err(errors::value)?, friction)?), objects })
    }

    /// The equilibrium that the rod is in.
    #[getter]
    fn state(&self, py: Python<'_>) -> PyState {
        PyState { state: py.detach(|| self.lock_follower().state().clone()) }
    }

    /// Bring the clamp to a pose, straight and at a constant ratio of turn and way.
    ///
    /// Parameters
    /// ----------
    /// pose : tuple of float
    ///     x (m), y (m), phi (rad).
    ///
    /// Returns
    /// -------
    /// list of Event and State
    ///     All transitions on the way in order, and the state there as the last item.
    ///
    /// Raises
    /// ------
    /// SweepStopped
    ///     The rod cannot be followed to there; it stays in the equilibrium in which it was. ``tau`` is the share of the move.
    fn to<'py>(&self, py: Python<'py>, pose: PyPose) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let items = running::run(py, || self.lock_follower().to(pose.0))?;
        let item = |item| match item {
            Item::State(state) => Ok(Bound::new(py, PyState { state })?.into_any()),
            Item::Event(event) => Ok(Bound::new(py, PyEvent { event })?.into_any()),
        };
        items.map_err(|stop| errors::stopped(py, &stop, None))?.into_iter().map(item).collect()
    }

    /// A follower in the same equilibrium, which goes its own way.
    ///
    /// Returns
    /// -------
    /// Follower
    fn clone(&self, py: Python<'_>) -> PyResult<Self> {
        let follower = Mutex::new(running::run(py, || self.lock_follower().clone())?);
        Ok(Self { follower, objects: self.objects.clone() })
    }

    fn __copy__(&self, py: Python<'_>) -> PyResult<Self> {
        self.clone(py)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let state = self.state(py);
        format!("<vibrissa.Follower {} at clamp {:?}>", state.state.phase(), crate::pose::tuple(state.state.pose))
    }
}
