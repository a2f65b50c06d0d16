//! From the reactions to the object.

use crate::array::{Column, Get, structured};
use crate::reading::{Answer, numbers_and_reasons};
use crate::recording::PyRecording;
use crate::rod::PyRod;
use crate::samples::{SAMPLE, Samples};
use crate::simulate::model;
use crate::{errors, running};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;
use rod_files::{FittedPoint, Reconstructed, ReconstructionError, Recording, Together};
use std::path::PathBuf;
use vibrissa::reconstruct::kink::{Kink, KinkKind};
use vibrissa::reconstruct::{
    Basis, Budget, Evidence, Finding, Friction, Reading, SimpleShape, Source, SourceEstimate, TraceRow,
};
use vibrissa::{Label, Sample, Settings};

const TRACE: &[Column<TraceRow>] = &[
    Column { name: "stretch", get: Get::Int(|row| row.stretch as i64) },
    Column { name: "kind", get: Get::Text(|row| row.kind.to_string().into()) },
    Column { name: "x", get: Get::Float(|row| row.x) },
    Column { name: "y", get: Get::Float(|row| row.y) },
    Column { name: "alpha", get: Get::Float(|row| row.alpha) },
    Column { name: "sigma", get: Get::Float(|row| row.sigma) },
    Column { name: "sigma_systematic", get: Get::Float(|row| row.sigma_systematic) },
];

const KINK: &[Column<Kink>] = &[
    Column { name: "next", get: Get::Int(|kink| kink.next as i64) },
    Column {
        name: "kind",
        get: Get::Text(|kink| if kink.kind == KinkKind::Jump { "jump".into() } else { "kink".into() }),
    },
    Column { name: "sigma", get: Get::Float(|kink| kink.sigma_tau) },
    Column { name: "score", get: Get::Float(|kink| kink.score) },
];

pub const FITTED: &[Column<FittedPoint>] = &[
    Column { name: "object", get: Get::Int(|row| row.object as i64) },
    Column { name: "x", get: Get::Float(|row| row.x) },
    Column { name: "y", get: Get::Float(|row| row.y) },
    Column { name: "known", get: Get::Text(|row| row.known.into()) },
    Column { name: "sigma", get: Get::Float(|row| row.sigma.unwrap_or(f64::NAN)) },
    Column { name: "room", get: Get::Float(|row| row.room.unwrap_or(f64::NAN)) },
    Column { name: "vertex", get: Get::Flag(|row| row.vertex) },
];

/// A simple shape, and the number of one of its parameters.
type ShapeRow = (SimpleShape, usize);

const SHAPE: &[Column<ShapeRow>] = &[
    Column { name: "object", get: Get::Int(|row| row.0.object as i64) },
    Column { name: "first", get: Get::Int(|row| row.0.points.start as i64) },
    Column { name: "last", get: Get::Int(|row| row.0.points.end as i64 - 1) },
    Column { name: "shape", get: Get::Text(|row| row.0.kind.to_string().into()) },
    Column { name: "evidence", get: Get::Float(|row| row.0.evidence) },
    Column { name: "p_value", get: Get::Float(|row| row.0.p_value) },
    Column { name: "parameter", get: Get::Text(|row| row.0.parameters[row.1].0.clone().into()) },
    Column { name: "value", get: Get::Float(|row| row.0.parameters[row.1].1) },
    Column { name: "sigma", get: Get::Float(|row| row.0.parameters[row.1].2) },
];

const ESTIMATE: &[Column<SourceEstimate>] = &[
    Column { name: "source", get: Get::Text(|estimate| name(estimate.source).into()) },
    Column { name: "unit", get: Get::Text(|estimate| estimate.source.name().1.into()) },
    Column { name: "known", get: Get::Float(|estimate| estimate.known) },
    Column { name: "given", get: Get::Float(|estimate| estimate.given) },
    Column { name: "budget", get: Get::Float(|estimate| estimate.budget) },
    Column { name: "value", get: Get::Float(|estimate| estimate.value) },
    Column { name: "sigma", get: Get::Float(|estimate| estimate.sigma) },
    Column { name: "taken", get: Get::Float(|estimate| estimate.taken) },
    Column { name: "raised", get: Get::Flag(|estimate| estimate.raised) },
];

/// The name of a source in files.
fn name(source: Source) -> String {
    let name = serde_json::to_value(source).ok();
    name.and_then(|name| name.as_str().map(str::to_owned)).unwrap_or_else(|| source.to_string())
}

/// A reconstruction: a phase and contact points for each sample, and the contour.
#[pyclass(frozen, name = "Reconstruction", module = "vibrissa")]
pub struct PyReconstruction {
    rod: PyRod,
    found: Reconstructed,
    settings: Settings,
    readings: PyOnceLock<Py<PyAny>>,
    reasons: PyOnceLock<Py<PyAny>>,
}

#[pymethods]
impl PyReconstruction {
    /// The rod that was assumed.
    #[getter]
    fn rod(&self) -> PyRod {
        self.rod.clone()
    }

    /// The samples, as the fields of ``Recording.samples``.
    #[getter]
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let given = |(number, sample): (usize, &Sample)| Sample { pose: self.found.pose(number), ..*sample };
        let samples: Vec<Sample> = self.found.samples.iter().enumerate().map(given).collect();
        structured(py, SAMPLE, samples.iter())
    }

    /// The answers as a structured array, one row for each sample.
    ///
    /// Fields: pose ``x0``, ``y0`` (m), ``phi0`` (rad); ``label``: ``free``, ``A``, ``B``, ``BA`` or ``BB``, with its ``probability``
    /// and its ``basis``: what decided; the contact, or the first of several: ``x``, ``y``, ``s`` (m), ``alpha`` (rad), ``force`` (N),
    /// standard deviations ``sigma_x``, ``sigma_y`` (m), and ``systematic_x``, ``systematic_y`` (m): the part of them that all samples
    /// share; ``second_...``: the second of several. NaN and empty texts where there is none; :attr:`reasons` tells why.
    #[getter]
    fn readings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let make = || {
            let rows = py.detach(|| self.answers());
            structured(py, numbers_and_reasons().0, rows.iter()).map(Bound::unbind)
        };
        Ok(self.readings.get_or_try_init(py, make)?.bind(py).clone())
    }

    /// Why there is no contact point, as a structured array, one row for each sample.
    ///
    /// Fields: ``reason`` and, of the second of several contacts, ``second_reason``; empty where there is a point. These texts take
    /// much more room than all numbers, so they are made when they are first asked for.
    #[getter]
    fn reasons<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let make = || {
            let rows = py.detach(|| self.answers());
            structured(py, numbers_and_reasons().1, rows.iter()).map(Bound::unbind)
        };
        Ok(self.reasons.get_or_try_init(py, make)?.bind(py).clone())
    }

    /// The contour as a structured array.
    ///
    /// Fields: ``stretch``: number of the stretch, between which nothing is known; ``kind``: ``single``, ``first`` or ``second`` of
    /// two contacts; ``x``, ``y`` (m); ``alpha``: tangent angle (rad); ``sigma``: standard deviation across the contour (m);
    /// ``sigma_systematic``: the part of it that all samples share (m).
    #[getter]
    fn contour<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<TraceRow> = self.found.contour.rows().collect();
        structured(py, TRACE, rows.iter())
    }

    /// Neighbouring samples with one label: first sample, last sample + 1, label.
    #[getter]
    fn runs(&self) -> Vec<(usize, usize, String)> {
        self.found.runs().map(|(samples, label)| (samples.start, samples.end, label.to_string())).collect()
    }

    /// Kinks and jumps of the reactions as a structured array.
    ///
    /// Fields: ``next``: the first sample after it; ``kind``: ``kink`` (the slopes change) or ``jump`` (the values change); ``sigma``:
    /// standard deviation of its place (m); ``score``: sum over the channels of (change / standard deviation)^2.
    #[getter]
    fn kinks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        structured(py, KINK, self.found.found.kinks.iter())
    }

    /// Errors that all samples share, as a structured array; empty where none were estimated.
    ///
    /// Fields, in the ``unit`` of each ``source`` (SI, relative where empty): what was ``known`` before, standard deviations ``given``
    /// and ``budget`` as used, the estimate ``value`` with its ``sigma``, what was ``taken`` off, whether the budget was ``raised``.
    #[getter]
    fn calibration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let sources = self.found.found.calibration().map_or(&[][..], |calibration| &calibration.sources);
        structured(py, ESTIMATE, sources.iter())
    }

    /// Standard deviations of a sample of f0x, f0y (N) and m0z (N m) that were found or given.
    #[getter]
    fn noise(&self) -> (f64, f64, f64) {
        let [f0x, f0y, m0z] = self.found.found.noise;
        (f0x.sigma, f0y.sigma, m0z.sigma)
    }

    /// Whether recording, units and rod fit together.
    #[getter]
    fn fits(&self) -> bool {
        self.found.fits()
    }

    /// What the check by the physics found, in words.
    #[getter]
    fn findings(&self) -> Vec<String> {
        self.found.findings().map(Finding::to_string).collect()
    }

    /// Whether one contour explains the whole recording; None where none was fitted: without ``fit``, without noise, and where
    /// signs, units or rod are wrong. Where it does, labels, points, contour and errors are its own.
    #[getter]
    fn is_explained(&self) -> Option<bool> {
        self.found.fitted().map(|fit| fit.goodness.explains)
    }

    /// Why no contour explains the whole recording, and where, in words; None where one does, and where none was fitted.
    #[getter]
    fn contradiction(&self) -> Option<String> {
        self.found.contradiction()
    }

    /// The contour that explains the whole recording best, as a structured array; empty where none was fitted.
    ///
    /// Fields: ``object``, counted from 0; points ``x``, ``y`` (m); ``known``: "touched" where the rod touches there, or nearer to it than to its neighbours, "bounded"
    /// where it passed outside, "unknown" where it was not; ``sigma``: standard deviation across the contour (m), NaN where it is not touched; ``room``: how far
    /// the object may reach beyond the point at most (m), NaN where it is not bounded; ``vertex``: whether smooth pieces meet at an angle there.
    #[getter]
    fn fitted<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<FittedPoint> = self.found.fitted_contour().into_iter().flatten().collect();
        structured(py, FITTED, rows.iter())
    }

    /// Simple shapes that explain an object of the fit as well as its free contour does, as a structured array with a row for each parameter; the best shape of
    /// an object first. Empty where no contour explains the recording.
    ///
    /// Fields: ``object``, counted from 0; ``first`` and ``last``: the points of the object in ``fitted`` that it describes, counted from 0; ``shape``: "line", "polygon", "arc", "ellipse" or "parabola"; ``evidence``: Bayesian information criterion less that of the
    /// best shape of the object; ``p_value``: probability of an increase of chi squared over the free contour that is at least as large; ``parameter``: as the fields of scene files; ``value`` and
    /// ``sigma``: in m, 1/m and rad.
    #[getter]
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shapes = self.found.fitted().map_or(&[][..], |fit| &fit.shapes);
        let of_shape = |shape: &SimpleShape| {
            let shape = shape.clone();
            (0..shape.parameters.len()).map(move |parameter| (shape.clone(), parameter))
        };
        let rows: Vec<ShapeRow> = shapes.iter().flat_map(of_shape).collect();
        structured(py, SHAPE, rows.iter())
    }

    /// The likely causes of a misfit.
    ///
    /// Returns
    /// -------
    /// list of tuple
    ///     Explanations in words with their likelihoods, which add up to 1, the likeliest first; empty where everything fits, and of a rod
    ///     that is not uniform or not straight at rest.
    fn explain(&self, py: Python<'_>) -> PyResult<Vec<(String, f64)>> {
        let Reconstructed { rod, samples, check, .. } = &self.found;
        let Some(rod) = rod.uniform().filter(|_| !check.fits()) else { return Ok(Vec::new()) };
        let tried =
            running::run(py, || vibrissa::reconstruct::explanations(rod, samples, &self.settings, &check.findings))?;
        Ok(tried.into_iter().map(|(what, share)| (what.to_string(), share)).collect())
    }

    /// The answers, or the contour, as a pandas data frame.
    ///
    /// Parameters
    /// ----------
    /// table : {"readings", "contour"}, optional
    ///     Which.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///     With the units of its columns in ``attrs["units"]``.
    #[pyo3(signature = (table="readings"))]
    fn to_pandas<'py>(&self, py: Python<'py>, table: &str) -> PyResult<Bound<'py, PyAny>> {
        py.import("vibrissa._tables")?.call_method1("to_pandas", self.rows(py, table)?)
    }

    /// The answers, or the contour, as an Arrow table.
    ///
    /// Parameters
    /// ----------
    /// table : {"readings", "contour"}, optional
    ///     Which.
    ///
    /// Returns
    /// -------
    /// pyarrow.Table
    ///     With the unit of each column in the metadata of its field.
    #[pyo3(signature = (table="readings"))]
    fn to_arrow<'py>(&self, py: Python<'py>, table: &str) -> PyResult<Bound<'py, PyAny>> {
        py.import("vibrissa._tables")?.call_method1("to_arrow", self.rows(py, table)?)
    }

    fn __len__(&self) -> usize {
        self.found.samples.len()
    }

    fn __repr__(&self) -> String {
        let labels: Vec<_> = self.found.found.runs.iter().map(|run| run.1.to_string()).collect();
        format!("<vibrissa.Reconstruction of {} samples, phases {}>", self.found.samples.len(), labels.join(" "))
    }
}

impl PyReconstruction {
    /// The reconstruction itself.
    pub fn found(&self) -> &Reconstructed {
        &self.found
    }

    fn answers(&self) -> Vec<Answer> {
        let found = &self.found.found;
        let mut last: Option<(&Evidence, Label, Basis)> = None;
        let mut basis = |number: usize, label: Label| {
            let evidence = found.evidence(number)?;
            // neighbouring samples have the same place, whose evidence says the same
            let known = last.filter(|(of, to, _)| std::ptr::eq(*of, evidence) && *to == label);
            let basis = known.map_or_else(|| evidence.basis(label), |known| known.2);
            last = Some((evidence, label, basis));
            Some(basis)
        };
        let answer = |(number, reading): (usize, &Reading)| Answer {
            pose: self.found.pose(number),
            reading: Some(*reading),
            basis: basis(number, reading.label),
        };
        found.readings.iter().enumerate().map(answer).collect()
    }

    /// The arrays that a table is made of.
    fn rows<'py>(&self, py: Python<'py>, table: &str) -> PyResult<Bound<'py, PyTuple>> {
        match table {
            "readings" => (self.readings(py)?, self.reasons(py)?).into_pyobject(py),
            "contour" => (self.contour(py)?,).into_pyobject(py),
            _ => Err(errors::value(format!("table is {table:?}, expected \"readings\" or \"contour\""))),
        }
    }
}

/// Samples as a recording that no file has.
fn recording(samples: Samples) -> Recording {
    Recording {
        file: PathBuf::from("samples"),
        rows: samples.0.into_iter().map(Ok).collect(),
        ignored: Vec::new(),
        late: Vec::new(),
        cut: false,
        incomplete: None,
        notes: Vec::new(),
    }
}

/// Reconstruct phases, contact points and the contour from a recording, as the command ``vibrissa reconstruct`` does.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod, on any clamp.
/// samples : Recording or table
///     A recording; or a table with the columns ``x0``, ``y0`` (m), ``phi0`` (rad), ``f0x``, ``f0y`` (N), ``m0z`` (N m), perhaps ``t``
///     (s) and ``sigma_f0x``, ``sigma_f0y``, ``sigma_m0z``: a structured array (``Scan.states``), a data frame, a mapping; or an array
///     of shape (n, 6).
/// noise : mapping, str or os.PathLike, optional
///     The noise of the sensor as for :func:`simulate`; without it the noise is estimated from the samples.
/// false_alarms : float, optional
///     Upper bound of the expected number of false alarms of the search for kinks, per scan; 0.1 by default.
/// largest_sigma : float, optional
///     Largest standard deviation of a contact point across the contour, in lengths of the rod; 0.02 by default.
/// as_is : bool, optional
///     Take samples and rod for exact. Otherwise errors that all samples share (bias, gain, angles and so on, as large as in an
///     ordinary laboratory) are estimated and taken off.
/// friction : float, tuple of two floats or str, optional
///     Coulomb friction of rod and object: its coefficient, the coefficient and its standard deviation, or "estimate". Without it there
///     is none.
/// fit : bool, optional
///     Fit one contour to the whole recording, which takes seconds, or a minute where none explains it. Where one does, labels, points,
///     contour and errors are its own; else a warning says where it fails. Without it samples are answered from their neighbours alone,
///     in a fraction of a second. Without noise nothing is fitted.
///
/// Returns
/// -------
/// Reconstruction
///
/// Raises
/// ------
/// ValueError
///     Too few samples can be used, or an argument is not possible.
#[pyfunction]
#[pyo3(signature = (rod, samples, *, noise=None, false_alarms=None, largest_sigma=None, as_is=false, friction=None, fit=true))]
#[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
pub fn reconstruct(
    py: Python<'_>,
    rod: &PyRod,
    samples: &Bound<'_, PyAny>,
    noise: Option<&Bound<'_, PyAny>>,
    false_alarms: Option<f64>,
    largest_sigma: Option<f64>,
    as_is: bool,
    friction: Option<&Bound<'_, PyAny>>,
    fit: bool,
) -> PyResult<PyReconstruction> {
    let settings = settings_of(noise, false_alarms, largest_sigma, as_is, friction)?;
    let recording = recording_of(samples)?;
    let given = rod.rod.clone();
    let reconstructed = || {
        let mut found = Reconstructed::new(recording, given, &settings)?;
        if fit {
            found.fit(&settings);
        }
        Ok(found)
    };
    let found = running::run(py, reconstructed)?.map_err(|error: ReconstructionError| errors::value(error))?;
    told(py, rod, found, settings)
}

/// The settings that keywords give.
fn settings_of(
    noise: Option<&Bound<'_, PyAny>>,
    false_alarms: Option<f64>,
    largest_sigma: Option<f64>,
    as_is: bool,
    friction: Option<&Bound<'_, PyAny>>,
) -> PyResult<Settings> {
    let default = Settings::default();
    Ok(Settings {
        noise: noise.map(model).transpose()?.map(|model| model.channels()),
        false_alarms: false_alarms.unwrap_or(default.false_alarms),
        largest_sigma: largest_sigma.unwrap_or(default.largest_sigma),
        budget: as_is.then_some(Budget::NONE),
        known: default.known,
        friction: friction.map_or(Ok(default.friction), friction_of)?,
    })
}

fn recording_of(samples: &Bound<'_, PyAny>) -> PyResult<Recording> {
    match samples.downcast::<PyRecording>() {
        Ok(recording) => Ok(recording.get().recording.clone()),
        Err(_) => Ok(recording(samples.extract()?)),
    }
}

/// A reconstruction, with warnings of what does not fit.
fn told(py: Python<'_>, rod: &PyRod, found: Reconstructed, settings: Settings) -> PyResult<PyReconstruction> {
    let mut doubts: Vec<String> = Vec::new();
    if !found.fits() {
        let findings: Vec<_> = found.findings().map(ToString::to_string).collect();
        doubts.push(format!("recording, units and rod do not fit: {}", findings.join("; ")));
    }
    doubts.extend(found.contradiction().into_iter().chain(found.doubts()));
    doubts.iter().try_for_each(|text| errors::warn(py, text))?;
    let rod = rod.clone();
    Ok(PyReconstruction { rod, found, settings, readings: PyOnceLock::new(), reasons: PyOnceLock::new() })
}

/// Reconstruct several recordings of one object with one contour, as the command ``vibrissa reconstruct`` does.
///
/// Each recording has a bias and a drift of its own; all other errors of rod, sensor, clamp and stage are those of all. If each
/// recording has a contour that explains it, but none was found that explains all, each keeps its own result, and a warning says so.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod of all recordings.
/// samples : sequence of Recording or table
///     The recordings, with poses in one frame, each as for :func:`reconstruct`.
/// noise, false_alarms, largest_sigma, as_is
///     As for :func:`reconstruct`.
///
/// Returns
/// -------
/// list of Reconstruction
///     One for each recording.
///
/// Raises
/// ------
/// ValueError
///     Too few samples of a recording can be used, or an argument is not possible.
#[pyfunction]
#[pyo3(signature = (rod, samples, *, noise=None, false_alarms=None, largest_sigma=None, as_is=false))]
pub fn reconstruct_together(
    py: Python<'_>,
    rod: &PyRod,
    samples: Vec<Bound<'_, PyAny>>,
    noise: Option<&Bound<'_, PyAny>>,
    false_alarms: Option<f64>,
    largest_sigma: Option<f64>,
    as_is: bool,
) -> PyResult<Vec<PyReconstruction>> {
    let settings = settings_of(noise, false_alarms, largest_sigma, as_is, None)?;
    let recordings: Vec<Recording> = samples.iter().map(recording_of).collect::<PyResult<_>>()?;
    let given = rod.rod.clone();
    let reconstructed = || {
        let local = |recording| Reconstructed::new(recording, given.clone(), &settings);
        let mut found: Vec<Reconstructed> =
            recordings.into_iter().map(local).collect::<Result<_, ReconstructionError>>()?;
        let together = Together::fit(&mut found, &settings, |_| {});
        Ok((found, together))
    };
    let (found, together) =
        running::run(py, reconstructed)?.map_err(|error: ReconstructionError| errors::value(error))?;
    if let Some(why) = together.and_then(|together| together.contradiction()) {
        errors::warn(py, &why)?;
    }
    found.into_iter().map(|one| told(py, rod, one, settings)).collect()
}

/// What is known of friction, from a coefficient, a coefficient with its standard deviation, or a word.
fn friction_of(friction: &Bound<'_, PyAny>) -> PyResult<Friction> {
    if let Ok(mu) = friction.extract::<f64>() {
        return Ok(Friction::Known { mu, sigma: 0.0 });
    }
    if let Ok((mu, sigma)) = friction.extract::<(f64, f64)>() {
        return Ok(Friction::Known { mu, sigma });
    }
    match friction.extract::<String>()?.as_str() {
        "estimate" => Ok(Friction::Estimate),
        "none" => Ok(Friction::None),
        other => Err(errors::value(format!(
            "friction is {other:?}, expected a number, a pair of numbers, \"estimate\" or \"none\""
        ))),
    }
}
