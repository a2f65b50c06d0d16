//! Recordings from files.

use crate::array::structured;
use crate::errors;
use crate::path::PyPath;
use crate::rod::PyRod;
use crate::running;
use crate::samples::SAMPLE;
use pyo3::prelude::*;
use rod_files::{LiveError, LiveScan, ReadOptions, Recording, RecordingError, Setup, StageDelay, StageSpec};
use std::path::PathBuf;
use vibrissa::reconstruct::{Budget, Known};

/// What a clamp felt along its way, from a file.
#[pyclass(frozen, name = "Recording", module = "vibrissa")]
pub struct PyRecording {
    pub recording: Recording,
}

#[pymethods]
impl PyRecording {
    /// A recording from a file.
    ///
    /// Tables (CSV, TSV, LVM) have the columns x0, y0 (m), phi0 (rad), f0x, f0y (N), m0z (N m), or others with units in their names
    /// (``docs/recordings.md``). Raw values and wrenches, in tables, TDMS or MCAP files, need ``stage``.
    ///
    /// Parameters
    /// ----------
    /// file : str or os.PathLike
    ///     The file.
    /// rod : Rod
    ///     The rod; its length says how far a clamp that turns has gone.
    /// setup : str or os.PathLike, optional
    ///     A TOML file that describes the sensor.
    /// stage : str, optional
    ///     How the clamp moves: ``"constant:SPEED"`` along ``path`` in m/s, or ``"table:FILE"``.
    /// stage_delay : float, optional
    ///     Delay of the clock of a stage's table, s: a pose that the table has at time t is that of the clamp at t + stage_delay on the clock of
    ///     the file. Without it, that of the setup, or 0.
    /// path : ClampPath, optional
    ///     The path of a clamp of constant speed.
    ///
    /// Returns
    /// -------
    /// Recording
    ///
    /// Raises
    /// ------
    /// OSError
    ///     The file cannot be read.
    /// ValueError
    ///     It is no recording: columns are missing, most rows cannot be used, or the arguments do not suit it.
    #[staticmethod]
    #[pyo3(signature = (file, rod, *, setup=None, stage=None, stage_delay=None, path=None))]
    fn read(
        py: Python<'_>,
        file: PathBuf,
        rod: &PyRod,
        setup: Option<PathBuf>,
        stage: Option<&str>,
        stage_delay: Option<f64>,
        path: Option<&Bound<'_, PyPath>>,
    ) -> PyResult<Self> {
        let setup = setup.map_or_else(|| Ok(Setup::default()), |file| Setup::read(&file)).map_err(errors::file)?;
        let stage: Option<StageSpec> = stage.map(str::parse).transpose().map_err(errors::value)?;
        let stage_delay = stage_delay.map(StageDelay::new).transpose().map_err(errors::value)?;
        if stage_delay.is_some() && !matches!(stage, Some(StageSpec::Table(_))) {
            return Err(errors::value("stage_delay is for the table of a stage, expected stage=\"table:FILE\""));
        }
        let path = path.and_then(|path| path.get().path.straight());
        let rod = *rod.rod.at_clamp();
        let (budget, known, read) = (Budget::laboratory(&rod), Known::NOTHING, ReadOptions::default());
        let scan = LiveScan { rod, budget, known, setup, stage, stage_delay, path, read, inputs: Vec::new() };
        let recording = running::run(py, || scan.recording(&file))?.map_err(|error| match error {
            LiveError::Recording(RecordingError::Unreadable { ref source, .. }) => errors::unreadable(source, &error),
            error => errors::value(error),
        })?;
        Ok(Self { recording })
    }

    /// The usable samples as a structured array.
    ///
    /// Fields: ``t`` (s), ``x0``, ``y0`` (m), ``phi0`` (rad), ``f0x``, ``f0y`` (N), ``m0z`` (N m), ``sigma_f0x``, ``sigma_f0y``,
    /// ``sigma_m0z``. NaN where there is no time, or no standard deviations.
    #[getter]
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        structured(py, SAMPLE, self.recording.rows.iter().flatten())
    }

    /// What is wrong with the other rows, in words.
    #[getter]
    fn faults(&self) -> Vec<String> {
        self.recording.faults().map(ToString::to_string).collect()
    }

    /// What else may be wrong with the file, in words.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.recording.warnings()
    }

    fn __len__(&self) -> usize {
        self.recording.samples().count()
    }

    fn __repr__(&self) -> String {
        format!("<vibrissa.Recording {} of {} samples>", self.recording.file.display(), self.__len__())
    }
}
