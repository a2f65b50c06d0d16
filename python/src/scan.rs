//! A sweep's results.

use crate::array::{ragged, structured, whole};
use crate::composite::PyComposite;
use crate::errors;
use crate::event::{EVENT, PyEvent};
use crate::path::PyPath;
use crate::pickle::Reduced;
use crate::rod::PyRod;
use crate::state::{CONTACT, PyState, STATE, points};
use numpy::PyArray2;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use vibrissa::contact::{Outcome, Stop};
use vibrissa::{Event, State};

/// States and transitions of a sweep, in order.
///
/// ``UNITS`` has the units of all fields by their names.
#[pyclass(frozen, name = "Scan", module = "vibrissa")]
pub struct PyScan {
    rod: Py<PyRod>,
    objects: Vec<Py<PyComposite>>,
    path: Py<PyPath>,
    outcome: Outcome,
    tables: [PyOnceLock<Py<PyAny>>; 3],
}

impl PyScan {
    pub fn new((rod, objects, path): (Py<PyRod>, Vec<Py<PyComposite>>, Py<PyPath>), outcome: Outcome) -> Self {
        Self { rod, objects, path, outcome, tables: [const { PyOnceLock::new() }; 3] }
    }

    fn at(&self, index: isize, count: usize, what: &str) -> PyResult<usize> {
        let from_end = if index < 0 { index + count as isize } else { index };
        let none = || PyIndexError::new_err(format!("{what} {index} of {count}"));
        usize::try_from(from_end).ok().filter(|index| *index < count).ok_or_else(none)
    }

    /// A table that is made when it is first asked for.
    fn table<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        make: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let table = self.tables[number].get_or_try_init(py, || make().map(Bound::unbind))?;
        Ok(table.bind(py).clone())
    }
}

#[pymethods]
impl PyScan {
    /// The rod.
    #[getter]
    fn rod(&self, py: Python<'_>) -> Py<PyRod> {
        self.rod.clone_ref(py)
    }

    /// The objects.
    #[getter]
    fn objects(&self, py: Python<'_>) -> Vec<Py<PyComposite>> {
        self.objects.iter().map(|object| object.clone_ref(py)).collect()
    }

    /// The path of the clamp.
    #[getter]
    fn path(&self, py: Python<'_>) -> Py<PyPath> {
        self.path.clone_ref(py)
    }

    /// The states as a structured array, one row for each reported pose.
    ///
    /// Fields: ``x0``, ``y0`` (m), ``phi0`` (rad) of the clamp; ``phase``; ``f0x``, ``f0y`` (N), ``m0z`` (N m) of the clamp on the
    /// rod; ``residual``; ``min_gap`` (m); ``stable``; ``energy`` (J); ``max_stress`` (Pa, NaN where the rod has no diameter);
    /// ``min_gap_bound`` (m), ``gap_proven``; ``leg`` of the path; ``min_force`` (N, NaN without contacts); ``first_integral``,
    /// ``condition``, ``iterations`` of the solve.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, 0, || structured(py, STATE, self.outcome.states.iter()))
    }

    /// The transitions as a structured array.
    ///
    /// Fields: ``kind``; ``from``, ``to``: the phases; ``x0``, ``y0`` (m), ``phi0`` (rad), ``f0x``, ``f0y`` (N), ``m0z`` (N m) just
    /// before; the same with ``_after`` just after; ``leg`` of the path; ``dissipated``: energy lost by friction and
    /// jumps since the sweep began, that of the event included (J, NaN without friction).
    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, 1, || structured(py, EVENT, self.outcome.events.iter()))
    }

    /// The energy (J) lost by friction and jumps; None without friction, and where it is not known.
    #[getter]
    fn dissipated(&self) -> Option<f64> {
        self.outcome.dissipated
    }

    /// The contacts of all states, in the list layout of Arrow.
    ///
    /// ``contacts[i]`` are those of state i from the clamp to the tip. Fields of ``contacts.values``: ``object``, ``piece``, from 0;
    /// ``kind``; ``s``: arc length from the clamp (m); ``x``, ``y`` (m); ``alpha``: tangent angle of the contour (rad); ``force`` (N), the normal
    /// one; ``mode``: "slip+", "slip-" or "stick" with friction, empty without; ``friction``: force on the rod along the contour (N), and
    /// ``slip``: slip coordinate (m), both NaN without friction.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.table(py, 2, || {
            let values = structured(py, CONTACT, self.outcome.states.iter().flat_map(|state| &state.contacts))?;
            ragged(py, self.outcome.states.iter().map(|state| state.contacts.len()), values)
        })
    }

    /// Why the sweep stopped before the end of the path, in words; None if it did not.
    #[getter]
    fn stop(&self) -> Option<String> {
        self.outcome.stop.as_ref().map(Stop::to_string)
    }

    /// The phases in order, such as ``["free", "A", "B", "BB", "BA", "B", "A", "free"]``.
    #[getter]
    fn phases(&self) -> Vec<String> {
        let first = self.outcome.states.first().map(State::phase).into_iter();
        let mut phases: Vec<_> = first.chain(self.outcome.events.iter().map(Event::to)).collect();
        phases.dedup();
        phases.iter().map(ToString::to_string).collect()
    }

    /// One of the states.
    ///
    /// Parameters
    /// ----------
    /// i : int
    ///     Its number, from 0; negative from the end.
    ///
    /// Returns
    /// -------
    /// State
    fn state(&self, i: isize) -> PyResult<PyState> {
        let i = self.at(i, self.outcome.states.len(), "state")?;
        Ok(PyState { state: self.outcome.states[i].clone() })
    }

    /// One of the transitions.
    ///
    /// Parameters
    /// ----------
    /// i : int
    ///     Its number, from 0; negative from the end.
    ///
    /// Returns
    /// -------
    /// Event
    fn event(&self, i: isize) -> PyResult<PyEvent> {
        let i = self.at(i, self.outcome.events.len(), "event")?;
        Ok(PyEvent { event: self.outcome.events[i].clone() })
    }

    /// Points of the rod in a state.
    ///
    /// Parameters
    /// ----------
    /// i : int
    ///     Number of the state, from 0; negative from the end.
    /// n : int, optional
    ///     Number of points at equal distances from clamp to tip, at least 2.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape (n, 3): x (m), y (m), slope angle phi (rad).
    #[pyo3(signature = (i, n=101))]
    fn shape<'py>(
        &self,
        py: Python<'py>,
        i: isize,
        #[pyo3(from_py_with = whole)] n: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let i = self.at(i, self.outcome.states.len(), "state")?;
        points(py, &self.outcome.states[i], &self.rod.get().rod, n)
    }

    /// The states, events or contacts as a pandas data frame.
    ///
    /// Parameters
    /// ----------
    /// table : {"states", "events", "contacts"}, optional
    ///     Which. Contacts have a column ``state`` with the number of their state.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///     With the units of its columns in ``attrs["units"]``.
    #[pyo3(signature = (table="states"))]
    fn to_pandas<'py>(slf: &Bound<'py, Self>, table: &str) -> PyResult<Bound<'py, PyAny>> {
        which(table)?;
        slf.py().import("vibrissa._tables")?.call_method1("scan_to_pandas", (slf, table))
    }

    /// The states, events or contacts as an Arrow table.
    ///
    /// Parameters
    /// ----------
    /// table : {"states", "events", "contacts"}, optional
    ///     Which. States have a column ``contacts`` of lists.
    ///
    /// Returns
    /// -------
    /// pyarrow.Table
    ///     With the unit of each column in the metadata of its field.
    #[pyo3(signature = (table="states"))]
    fn to_arrow<'py>(slf: &Bound<'py, Self>, table: &str) -> PyResult<Bound<'py, PyAny>> {
        which(table)?;
        slf.py().import("vibrissa._tables")?.call_method1("scan_to_arrow", (slf, table))
    }

    /// A scan from what pickling keeps of it.
    #[staticmethod]
    fn _from_json(rod: Py<PyRod>, objects: Vec<Py<PyComposite>>, path: Py<PyPath>, text: &str) -> PyResult<Self> {
        Ok(Self::new((rod, objects, path), serde_json::from_str(text).map_err(errors::value)?))
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let text = serde_json::to_string(&self.outcome).map_err(errors::value)?;
        let arguments = (self.rod(py), self.objects(py), self.path(py), text);
        Ok((py.get_type::<Self>().getattr("_from_json")?, arguments.into_pyobject(py)?))
    }

    fn __len__(&self) -> usize {
        self.outcome.states.len()
    }

    fn __repr__(&self) -> String {
        let stopped = if self.outcome.stop.is_some() { ", stopped early" } else { "" };
        format!("<vibrissa.Scan of {} states, phases {}{stopped}>", self.outcome.states.len(), self.phases().join(" "))
    }
}

fn which(table: &str) -> PyResult<()> {
    if ["states", "events", "contacts"].contains(&table) {
        return Ok(());
    }
    Err(errors::value(format!("table is {table:?}, expected \"states\", \"events\" or \"contacts\"")))
}
