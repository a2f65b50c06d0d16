//! Exploring an object scan by scan.

use crate::array::{Floats, structured, whole};
use crate::path::{Leg, PyClampPath, PyPath};
use crate::reconstruct::{FITTED, PyReconstruction};
use crate::rod::PyRod;
use crate::samples::Samples;
use crate::simulate::model;
use crate::{errors, running};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use rod_files::FittedPoint;
use std::sync::{Mutex, MutexGuard, PoisonError};
use vibrissa::plan::{Explorer, ExplorerSettings, Finish, Proposal, Purpose, Rectangle, Stage};
use vibrissa::reconstruct::Budget;

/// The next scan of an exploration.
#[pyclass(frozen, get_all, name = "Proposal", module = "vibrissa")]
pub struct PyProposal {
    /// The way of the clamp, a ``ClampPath``.
    path: Py<PyClampPath>,
    /// ``approach``: to find the object where nothing is known, or from a side that no touched part of it faces; ``contour``: to touch more of the contour, or to know it better.
    purpose: &'static str,
    /// Length of the contour that it is expected to touch newly or to make as certain as asked for, m; NaN of an approach.
    value: f64,
    /// Largest bending stress that is expected, Pa; NaN of an approach.
    largest_stress: f64,
    /// Force at the clamp at which the rig must stop and move back along the path, N: half as much again as expected.
    stop_force: f64,
    /// Moment at the clamp at which it must stop, N m: below it the rod bears its largest stress there.
    stop_moment: f64,
}

#[pymethods]
impl PyProposal {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<vibrissa.Proposal {} on {}>", self.purpose, self.path.bind(py).repr()?))
    }
}

impl PyProposal {
    fn new(py: Python<'_>, proposal: Proposal) -> PyResult<Self> {
        let Proposal { path, purpose, abort } = proposal;
        let (purpose, value, stress) = match purpose {
            Purpose::Approach => ("approach", f64::NAN, None),
            Purpose::Contour { forecast, value } => ("contour", value, forecast.largest_stress),
        };
        let leg = Leg::Straight { path, to: path.at(path.length()) };
        Ok(Self {
            path: Py::new(py, (PyClampPath, PyPath::new(path, Some(vec![leg]), None)))?,
            purpose,
            value,
            largest_stress: stress.unwrap_or(f64::NAN),
            stop_force: abort.force,
            stop_moment: abort.moment,
        })
    }
}

/// Proposes scans of an object of which only a box is known, takes what was measured on them, and proposes the next one.
///
/// The clamp of a proposed scan stays outside the box, or where the rod has been by the contours that were fitted so far: it does not enter the
/// object if that is in its box and these contours are right. Gains and stresses are expectations. Friction is not considered.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod: uniform, straight and rigidly clamped, with a diameter.
/// box : tuple of float
///     The object is in it: x and y of the lower left corner and of the upper right one, m.
/// noise : mapping, str or os.PathLike
///     The noise of the sensor as for :func:`simulate`.
/// stress : float, optional
///     Largest bending stress that the rod bears, Pa; by default its yield stress.
/// stage : tuple of float, optional
///     The clamp stays in this box, m, as ``box``; by default it goes anywhere.
/// angles : float or array_like, optional
///     Directions of the rod at its clamp that the stage can hold, rad; by default 12 all around.
/// distances : float or array_like, optional
///     Distances of the clamp's path from the object that are tried, m; by default 0.2, 0.4, 0.6 and 0.8 lengths of the rod.
/// rate : float, optional
///     Samples in a second, Hz.
/// speed : float, optional
///     Speed of the clamp, m/s.
/// sigma : float, optional
///     The contour is to be known with this standard deviation, m; by default 0.001 lengths of the rod.
/// least_gain : float, optional
///     A scan is proposed only if it is expected to add so much, m: contour newly touched, or made as certain as ``sigma``; by default 0.02 lengths
///     of the rod.
/// most_scans : int, optional
///     Most scans.
/// hypotheses : int, optional
///     Objects that are drawn to compute expectations.
/// seed : int, optional
///     Of the draws: the same one gives the same proposals.
/// as_is : bool, optional
///     Take samples and rod for exact, as in :func:`reconstruct`.
///
/// Raises
/// ------
/// ValueError
///     An argument is not possible, or the largest stress is not known.
#[pyclass(frozen, name = "Explorer", module = "vibrissa")]
pub struct PyExplorer {
    explorer: Mutex<Explorer>,
}

/// A box from its corners.
fn rectangle([x, y, to_x, to_y]: [f64; 4]) -> Rectangle {
    Rectangle { low: [x, y], high: [to_x, to_y] }
}

impl PyExplorer {
    fn lock(&self) -> MutexGuard<'_, Explorer> {
        self.explorer.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PyExplorer {
    #[new]
    #[pyo3(signature = (
        rod, r#box, *, noise, stress=None, stage=None, angles=None, distances=None, rate=500.0, speed=1e-3, sigma=None, least_gain=None,
        most_scans=40, hypotheses=4, seed=0, as_is=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
    fn new(
        rod: &PyRod,
        r#box: [f64; 4],
        noise: &Bound<'_, PyAny>,
        stress: Option<f64>,
        stage: Option<[f64; 4]>,
        angles: Option<Floats<'_>>,
        distances: Option<Floats<'_>>,
        rate: f64,
        speed: f64,
        sigma: Option<f64>,
        least_gain: Option<f64>,
        #[pyo3(from_py_with = whole)] most_scans: usize,
        #[pyo3(from_py_with = whole)] hypotheses: usize,
        #[pyo3(from_py_with = whole)] seed: u64,
        as_is: bool,
    ) -> PyResult<Self> {
        if !rod.rod.is_held_rigidly() {
            return Err(errors::value("the clamp of the rod gives way, expected a rigid one"));
        }
        let mut rod = *rod.uniform()?;
        if let Some(stress) = stress {
            rod = rod.with_yield_stress(stress).map_err(errors::value)?;
        }
        let defaults =
            ExplorerSettings::new(&rod, rectangle(r#box), model(noise)?.channels()).map_err(errors::value)?;
        let values = |values: Floats<'_>| values.view().iter().copied().collect::<Vec<f64>>();
        let mut reconstruction = defaults.reconstruction;
        reconstruction.budget = as_is.then_some(Budget::NONE);
        let settings = ExplorerSettings {
            stage: stage.map(|stage| Stage { bounds: rectangle(stage) }),
            angles: angles.map_or(defaults.angles, values),
            distances: distances.map_or(defaults.distances, values),
            spacing: speed / rate,
            speed,
            sigma: sigma.unwrap_or(defaults.sigma),
            least_gain: least_gain.unwrap_or(defaults.least_gain),
            reconstruction,
            most_scans,
            hypotheses,
            seed,
            ..defaults
        };
        Ok(Self { explorer: Mutex::new(Explorer::new(rod, settings).map_err(errors::value)?) })
    }

    /// The next scan; the same one until there is an update.
    ///
    /// Returns
    /// -------
    /// Proposal or None
    ///     None where the exploration is finished.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     A distance is not between 0 and the length of the rod.
    fn propose(&self, py: Python<'_>) -> PyResult<Option<PyProposal>> {
        let proposal = running::run(py, || self.lock().propose())?.map_err(errors::value)?;
        proposal.map(|proposal| PyProposal::new(py, proposal)).transpose()
    }

    /// Take the samples of the scan that was proposed last, as far as it was made.
    ///
    /// Parameters
    /// ----------
    /// samples : table
    ///     As for :func:`reconstruct`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     No scan was proposed, the samples begin elsewhere, or cannot be reconstructed; then nothing has changed.
    fn update(&self, py: Python<'_>, samples: Samples) -> PyResult<()> {
        running::run(py, || self.lock().update(&samples.0))?.map_err(errors::value)
    }

    /// Take a scan that was made and reconstructed before: what it knows of the contour, and where the rod passed.
    ///
    /// Parameters
    /// ----------
    /// found : Reconstruction
    ///     With a fitted contour that explains the recording.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     No fitted contour explains the recording.
    fn add(&self, py: Python<'_>, found: &PyReconstruction) -> PyResult<()> {
        let found = found.found();
        let fit = found.fitted().filter(|fit| fit.goodness.explains).ok_or_else(|| {
            errors::value(
                "no fitted contour explains the recording, expected a reconstruction of which `is_explained` is true",
            )
        })?;
        running::run(py, || self.lock().add_known(&found.samples, fit.objects.clone()))
    }

    /// Why the exploration is finished, or None: ``precise``, what was touched is known as well as asked for, and no scan is expected to add
    /// anything worth it; ``nothing left``, some of it is less certain; ``no object``, none can be drawn
    /// through what was touched; ``most scans``.
    #[getter]
    fn finished(&self) -> Option<&'static str> {
        self.lock().finished().map(|finish| match finish {
            Finish::Precise => "precise",
            Finish::NothingLeft => "nothing left",
            Finish::NoObject => "no object",
            Finish::MostScans => "most scans",
        })
    }

    /// What is known of the contour from all scans, as ``Reconstruction.fitted``.
    #[getter]
    fn known<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<FittedPoint> = FittedPoint::all(self.lock().known()).collect();
        structured(py, FITTED, rows.iter())
    }

    /// Touched points, m, of shape (n, 2), of which the proposals know nothing: no object is drawn through them, because its contour would cross itself there.
    #[getter]
    fn left_out<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = running::run(py, || self.lock().left_out())?;
        PyArray1::from_vec(py, points.concat()).reshape([points.len(), 2])
    }

    fn __repr__(&self) -> String {
        let explorer = self.lock();
        format!("<vibrissa.Explorer after {} scans>", explorer.scans().len())
    }
}
