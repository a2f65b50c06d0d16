//! Answers while samples come.

use crate::array::structured;
use crate::reading::{ANSWER, Answer};
use crate::rod::PyRod;
use crate::samples::Samples;
use crate::{errors, running};
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};
use vibrissa::reconstruct::{Budget, Known, LiveSession, LiveSettings, Reading};
use vibrissa::rod::{AnyRod, PhysicalRod, Reactions};
use vibrissa::{Pose, Sample};

/// Phases and single contact points while samples come, a fixed number of samples late. Several contacts are recognised, but
/// resolved by :func:`reconstruct` only.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// free : table
///     At least 100 samples of the free rod on its way, as for :func:`reconstruct`: noise and distance of the samples are taken
///     from them.
/// half_window : float, optional
///     Path length in m on either side of a sample whose reactions are used; by default 0.02 lengths of the rod, or 200 samples.
///     Twice as long detects kinks 2.8 times smaller, twice as late.
/// as_is : bool, optional
///     Take samples and rod for exact. Otherwise errors that all samples share, as large as in an ordinary laboratory, are
///     estimated as the scan goes on.
///
/// Raises
/// ------
/// ValueError
///     There are fewer than 100 samples of a moving clamp, or ``half_window`` is not positive.
#[pyclass(frozen, name = "Live", module = "vibrissa")]
pub struct PyLive {
    session: Mutex<LiveSession<Pose>>,
    delay: usize,
    /// Its clamp puts the base of the rod where it is.
    rod: AnyRod,
}

impl PyLive {
    /// Runs the session, and gives the answers that are due.
    fn due<'py>(
        &self,
        py: Python<'py>,
        go: impl FnOnce(&mut LiveSession<Pose>, &mut dyn FnMut(Pose, Option<Reading>)) + Send,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rows = running::run(py, || {
            let mut rows = Vec::new();
            let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
            go(&mut session, &mut |pose, reading| rows.push(Answer { pose, reading, basis: None }));
            rows
        })?;
        structured(py, ANSWER, rows.iter())
    }
}

#[pymethods]
impl PyLive {
    #[new]
    #[pyo3(signature = (rod, free, *, half_window=None, as_is=false))]
    fn new(py: Python<'_>, rod: &PyRod, free: Samples, half_window: Option<f64>, as_is: bool) -> PyResult<Self> {
        let (any, rod) = (rod.rod.clone(), rod.uniform()?);
        let budget = if as_is { Budget::NONE } else { Budget::laboratory(rod) };
        let created = running::run(py, || {
            let found = LiveSettings::of_free_rod(rod, &free.0, Reactions::default())?;
            let settings = LiveSettings { half_window: half_window.unwrap_or(found.half_window), ..found };
            LiveSession::with_errors(rod, &settings, &budget, &Known::NOTHING)
        })?;
        let session = created.map_err(errors::value)?;
        Ok(Self { delay: session.delay(), session: Mutex::new(session), rod: any })
    }

    /// Number of usable samples after a sample at which its answer comes.
    #[getter]
    fn delay(&self) -> usize {
        self.delay
    }

    /// Take samples, one or many, in order.
    ///
    /// Parameters
    /// ----------
    /// samples : table
    ///     As for :func:`reconstruct`.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     The answers that are due, in order, with the fields of ``Reconstruction.readings`` and ``reasons``; ``basis`` is empty.
    fn push<'py>(&self, py: Python<'py>, samples: Samples) -> PyResult<Bound<'py, PyAny>> {
        self.due(py, |session, answer| {
            for sample in &samples.0 {
                let at_base = Sample { pose: self.rod.base(sample.pose, &sample.reactions), ..*sample };
                session.push(sample.pose, Some(&at_base), &mut *answer);
            }
        })
    }

    /// End the scan.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     The remaining answers.
    fn finish<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.due(py, |session, answer| session.finish(&mut *answer))
    }

    fn __repr__(&self) -> String {
        format!("<vibrissa.Live, answers {} samples late>", self.delay)
    }
}
