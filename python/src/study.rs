//! Studies: the scenes of a file, and the row of one scene.

use crate::array::whole;
use crate::{errors, running};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyDict};
use rod_files::{Measured, Study, StudyError, StudyRow};
use std::path::PathBuf;

/// A scene and the values that some of its numbers take, from a file as ``docs/studies.md`` describes it.
///
/// Every combination of the values is a scene; the last parameter changes fastest. ``len(study)`` is their number.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> study = vibrissa.Study.read("studies/right_higher.toml")  # doctest: +SKIP
/// >>> scene = vibrissa.Scene.parse(study.text(1914), study.scene)  # doctest: +SKIP
#[pyclass(frozen, name = "Study", module = "vibrissa")]
pub struct PyStudy {
    study: Study,
    names: PyOnceLock<Vec<String>>,
}

#[pymethods]
impl PyStudy {
    /// A study from a TOML file.
    ///
    /// Parameters
    /// ----------
    /// file : str or os.PathLike
    ///     The file.
    ///
    /// Returns
    /// -------
    /// Study
    ///
    /// Raises
    /// ------
    /// OSError
    ///     The file or that of its scene cannot be read.
    /// ValueError
    ///     It is no study; the text tells line, column and field.
    #[staticmethod]
    fn read(file: PathBuf) -> PyResult<Self> {
        let file = std::path::absolute(&file).unwrap_or(file);
        Ok(Self { study: Study::read(&file).map_err(errors::file)?, names: PyOnceLock::new() })
    }

    /// The file of its scene; files that scenes name are relative to it.
    #[getter]
    fn scene(&self) -> PathBuf {
        self.study.scene.clone()
    }

    /// The names of the parameters.
    #[getter]
    fn names(&self, py: Python<'_>) -> Vec<String> {
        self.names.get_or_init(py, || self.study.names().map(str::to_owned).collect()).clone()
    }

    /// The values of the parameters in a scene.
    ///
    /// Parameters
    /// ----------
    /// number : int
    ///     The scene, from 0.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The values by the names of the parameters.
    fn values<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] number: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.check(number)?;
        self.names(py).into_iter().zip(self.study.values(number)).into_py_dict(py)
    }

    /// A scene as a scene file.
    ///
    /// Parameters
    /// ----------
    /// number : int
    ///     The scene, from 0.
    ///
    /// Returns
    /// -------
    /// str
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     There is no such scene.
    fn text(&self, #[pyo3(from_py_with = whole)] number: usize) -> PyResult<String> {
        self.study.text(number).map_err(errors::value)
    }

    /// What a worker needs for a scene: its text, or why there is none.
    fn _text_or_reason(
        &self,
        #[pyo3(from_py_with = whole)] number: usize,
    ) -> PyResult<(Option<String>, Option<String>)> {
        match self.study.text(number) {
            Ok(text) => Ok((Some(text), None)),
            Err(StudyError::Field { reason, .. }) => Ok((None, Some(reason))),
            Err(error) => Err(errors::value(error)),
        }
    }

    fn __len__(&self) -> usize {
        self.study.count()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<vibrissa.Study of {} scenes, parameters {}>", self.study.count(), self.names(py).join(", "))
    }
}

impl PyStudy {
    fn check(&self, number: usize) -> PyResult<()> {
        let (count, last) = (self.study.count(), self.study.count() - 1);
        if number < count {
            return Ok(());
        }
        Err(errors::value(format!("number is {number}, expected a scene from 0 to {last}")))
    }
}

/// status, phases, cycle, snaps, several, naive_error, touched, largest_moment, states, reason.
type Row = (
    &'static str,
    Option<String>,
    Option<&'static str>,
    Option<usize>,
    Option<f64>,
    Option<f64>,
    Option<f64>,
    Option<f64>,
    Option<usize>,
    Option<String>,
);

/// The row of a scene that is written as in a scene file, from ``status`` on, as ``vibrissa study`` computes it.
///
/// Files that the scene names are relative to ``file``, which is not opened.
#[pyfunction]
pub fn _study_row(py: Python<'_>, text: &str, file: PathBuf) -> PyResult<Row> {
    let row = running::run(py, || StudyRow::sweep(0, Vec::new(), &file, text))?;
    let (status, reason) = (row.status(), row.reason);
    Ok(match row.measured {
        None => (status, None, None, None, None, None, None, None, None, reason),
        Some(Measured { phases, cycle, snaps, several, naive_error, touched, largest_moment, states }) => {
            // as an empty cell of the command's table, which is no value
            let phases = (!phases.is_empty()).then_some(phases);
            let (several, largest_moment) = (Some(several), Some(largest_moment));
            (status, phases, cycle, Some(snaps), several, naive_error, touched, largest_moment, Some(states), reason)
        }
    })
}
