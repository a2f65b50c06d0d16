//! The sweep.

use crate::array::whole_or_none;
use crate::composite::{PyComposite, contours, objects};
use crate::errors;
use crate::friction::{Given, rubbing};
use crate::path::PyPath;
use crate::rod::PyRod;
use crate::running::{self, Watch};
use crate::scan::PyScan;
use crate::state::PyState;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use rod_files::SceneFriction;
use vibrissa::contact::{ContactError, Item, Outcome};
use vibrissa::rod::AnyRod;
use vibrissa::{Composite, State, Sweep};

/// Largest number of states of a sweep, which are all kept: some 6 GB.
const MOST_STATES: f64 = 2e7;

/// Distance of reported states: one for all legs of the path, or one for each.
pub enum Steps {
    One(f64),
    Each(Vec<f64>),
}

impl<'py> FromPyObject<'py> for Steps {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(step) = object.extract() {
            return Ok(Self::One(step));
        }
        let wrong = |_| {
            let found = object.repr().map_or_else(|_| "something else".to_owned(), |text| text.to_string());
            PyTypeError::new_err(format!("expected a number in m (or rad), or one for each leg, found {found}"))
        };
        object.extract().map(Self::Each).map_err(wrong)
    }
}

/// What a sweep is asked to do, without the interpreter.
struct Task<'a> {
    rod: &'a AnyRod,
    objects: &'a [Composite],
    path: &'a PyPath,
    steps: &'a Steps,
    start: Option<&'a State>,
    friction: Option<&'a SceneFriction>,
    most_steps: Option<u64>,
}

impl Task<'_> {
    fn run(&self) -> Result<Outcome, ContactError> {
        let Self { rod, objects, path, start, .. } = *self;
        let sweep = match (self.steps, start) {
            (Steps::One(step), None) => Sweep::new(rod, objects, path.shared(), *step)?,
            (Steps::One(step), Some(state)) => Sweep::from_state(rod, objects, state, path.shared(), *step)?,
            (Steps::Each(steps), _) => Sweep::with_steps(rod, objects, path.shared(), steps)?,
        };
        let sweep = rubbing(sweep, self.friction)?;
        let mut sweep = match self.most_steps {
            Some(most) => sweep.with_most_steps(most),
            None => sweep,
        };
        let (mut outcome, mut watch) = (Outcome::default(), Watch::new());
        for item in sweep.by_ref() {
            match item {
                Ok(Item::State(state)) => outcome.states.push(state),
                Ok(Item::Event(event)) => outcome.events.push(event),
                Err(stop) => outcome.stop = Some(stop),
            }
            if watch.should_end() {
                break;
            }
        }
        outcome.dissipated = sweep.dissipated();
        Ok(outcome)
    }
}

/// Sweep a rod along a path past objects.
///
/// The clamp goes along the path. States are reported at 0, step, 2 step, ... of each leg, and all transitions between phases are
/// located. Ctrl-C ends a sweep with ``KeyboardInterrupt``.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches. A shape is an object of its own.
/// path : Path
///     The way of the clamp.
/// step : float or sequence of float
///     Distance of reported states: m, or rad where the clamp only turns; one for all legs, or one for each.
/// start : State, optional
///     The equilibrium at the first pose, from which the sweep goes on. Without it, a start in contact has the shape that a
///     sweep from further back would have brought.
/// friction : float, tuple of float, or list, optional
///     Coulomb friction between rod and objects (``docs/friction.md``): one coefficient for all objects, ``(at_rest, slipping)``, or a
///     list with one of these for each object; an item of the list may itself be a list, with one for each piece. Without it, and where
///     all coefficients are 0, there is none.
/// most_steps : int, optional
///     Steps along branches of equilibria after which the sweep stops; by default 2 million.
///
/// Returns
/// -------
/// Scan
///     States and transitions.
///
/// Raises
/// ------
/// ValueError
///     An argument is not possible.
/// SweepStopped
///     The sweep could not go on; its ``scan`` has all before that.
///
/// Examples
/// --------
/// >>> import math, vibrissa
/// >>> rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
/// >>> object = vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)])
/// >>> path = vibrissa.ClampPath((0.08, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))
/// >>> scan = vibrissa.sweep(rod, object, path, step=1e-3)
/// >>> scan.phases
/// ['free', 'A', 'B', 'BB', 'BA', 'B', 'A', 'free']
#[pyfunction]
#[pyo3(signature = (rod, objects, path, step, *, start=None, friction=None, most_steps=None))]
pub fn sweep<'py>(
    rod: &Bound<'py, PyRod>,
    objects: &Bound<'py, PyAny>,
    path: &Bound<'py, PyPath>,
    step: Steps,
    start: Option<&Bound<'py, PyState>>,
    friction: Option<Given>,
    #[pyo3(from_py_with = whole_or_none)] most_steps: Option<u64>,
) -> PyResult<Bound<'py, PyScan>> {
    let objects = self::objects(objects)?;
    let friction = friction.map(|given| given.of(&contours(&objects))).transpose()?.flatten();
    run(rod, &objects, path, &step, &Options { start, friction: friction.as_ref(), most_steps })
}

/// What a sweep may be given beside what it needs.
pub struct Options<'a, 'py> {
    pub start: Option<&'a Bound<'py, PyState>>,
    pub friction: Option<&'a SceneFriction>,
    pub most_steps: Option<u64>,
}

/// The sweep of objects that are made already.
pub fn run<'py>(
    rod: &Bound<'py, PyRod>,
    objects: &[Bound<'py, PyComposite>],
    path: &Bound<'py, PyPath>,
    steps: &Steps,
    options: &Options<'_, 'py>,
) -> PyResult<Bound<'py, PyScan>> {
    let Options { start, friction, most_steps } = *options;
    if matches!((steps, start), (Steps::Each(_), Some(_))) {
        return Err(errors::value("step has a number for each leg, expected one number beside start"));
    }
    let py = rod.py();
    let contours = contours(objects);
    let (way, start) = (path.get(), start.map(|start| &start.get().state));
    if let Steps::Each(steps) = steps
        && steps.len() != way.count()
    {
        let (found, legs) = (steps.len(), way.count());
        return Err(errors::value(format!("step has {found} numbers, expected one, or {legs}: one for each leg")));
    }
    let shortest = match steps {
        Steps::One(step) => *step,
        Steps::Each(steps) => steps.iter().copied().fold(f64::INFINITY, f64::min),
    };
    let states = way.path.length() / shortest;
    if shortest > 0.0 && states > MOST_STATES {
        return Err(errors::value(format!(
            "step is {shortest:?}, which asks for {states:.1e} states, expected at most {MOST_STATES:.0e}"
        )));
    }
    let any = &rod.get().rod;
    let run = || Task { rod: any, objects: &contours, path: way, steps, start, friction, most_steps }.run();
    let outcome = running::run(py, run)?.map_err(errors::value)?;
    let objects = objects.iter().map(|object| object.clone().unbind()).collect();
    let given = (rod.clone().unbind(), objects, path.clone().unbind());
    let stop = outcome.stop.clone();
    let scan = Bound::new(py, PyScan::new(given, outcome))?;
    match stop {
        Some(stop) => Err(errors::stopped(py, &stop, Some(scan.into_any().unbind()))),
        None => Ok(scan),
    }
}
