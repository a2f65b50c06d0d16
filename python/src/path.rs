//! The way of the clamp.

use crate::array::{Floats, two};
use crate::pickle::{Constructor, Reduced, constructor};
use crate::pose::{PyPose, tuple};
use crate::{errors, running};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use rod_files::LegPath;
use std::sync::Arc;
use vibrissa::contact::{Chain, ClampArc, ClampSpline, Path, PathPoint};
use vibrissa::{ClampPath, Pose};

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyPath>()?;
    module.add_class::<PyClampPath>()?;
    module.add_class::<PyClampArc>()?;
    module.add_class::<PyClampSpline>()?;
    module.add_class::<PyChain>()
}

/// A leg of a path as scene files have it, with the numbers as they were given: those of the path have rounding errors.
#[derive(Clone, Copy)]
pub enum Leg {
    /// With its last pose.
    Straight { path: ClampPath, to: Pose },
    /// With the pivot (m) and the angle (rad).
    Pivot { path: ClampArc, pivot: [f64; 2], turn: f64 },
}

impl Leg {
    /// What the clamp goes along.
    pub fn path(&self) -> LegPath {
        match *self {
            Self::Straight { path, .. } => LegPath::Straight(path),
            Self::Pivot { path, .. } => LegPath::Pivot(path),
        }
    }
}

/// A path of the clamp: the poses that it runs through.
#[pyclass(frozen, subclass, name = "Path", module = "vibrissa")]
pub struct PyPath {
    pub path: Arc<dyn Path>,
    /// None where scene files have no such path.
    pub legs: Option<Vec<Leg>>,
    constructor: Option<Constructor>,
}

impl PyPath {
    pub fn new(path: impl Path + 'static, legs: Option<Vec<Leg>>, constructor: Option<Constructor>) -> Self {
        Self { path: Arc::new(path), legs, constructor }
    }

    pub fn shared(&self) -> Shared {
        Shared(self.path.clone())
    }

    /// One row for each parameter.
    fn table<'py>(
        &self,
        py: Python<'py>,
        t: &Floats<'py>,
        of: impl Fn(PathPoint) -> Pose + Sync,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let t: Vec<f64> = t.view().iter().copied().collect();
        let points = running::run(py, || t.iter().map(|&t| of(self.path.point(t))).collect::<Vec<_>>())?;
        Ok(Array2::from_shape_fn((t.len(), 3), |(i, k)| {
            let Pose { x, y, phi } = points[i];
            [x, y, phi][k]
        })
        .into_pyarray(py))
    }

    /// Number of legs.
    pub fn count(&self) -> usize {
        self.path.legs().len().max(1)
    }
}

/// A path that several sweeps go along.
pub struct Shared(Arc<dyn Path>);

impl Path for Shared {
    fn point(&self, t: f64) -> PathPoint {
        self.0.point(t)
    }

    fn length(&self) -> f64 {
        self.0.length()
    }

    fn legs(&self) -> &[Arc<dyn Path>] {
        self.0.legs()
    }

    fn straight(&self) -> Option<ClampPath> {
        self.0.straight()
    }
}

#[pymethods]
impl PyPath {
    /// Length of the path: m, plus rad of legs on which the clamp only turns.
    #[getter]
    fn length(&self) -> f64 {
        self.path.length()
    }

    /// Poses at parameters.
    ///
    /// Parameters
    /// ----------
    /// t : array_like
    ///     Parameters from 0 to ``length``.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape (n, 3): x (m), y (m), phi (rad).
    fn at<'py>(&self, py: Python<'py>, t: Floats<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.table(py, &t, |point| point.pose)
    }

    /// Rates of the poses at parameters.
    ///
    /// Parameters
    /// ----------
    /// t : array_like
    ///     Parameters from 0 to ``length``.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape (n, 3): the derivatives of x (m), y (m) and phi (rad) by the parameter.
    fn rate<'py>(&self, py: Python<'py>, t: Floats<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.table(py, &t, |point| point.rate)
    }

    /// The first pose: x (m), y (m), phi (rad).
    #[getter]
    fn start(&self) -> (f64, f64, f64) {
        tuple(self.path.point(0.0).pose)
    }

    /// The last pose: x (m), y (m), phi (rad).
    #[getter]
    fn end(&self) -> (f64, f64, f64) {
        tuple(self.path.point(self.path.length()).pose)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let path = slf.get();
        let name = slf.get_type().name()?.to_string();
        Ok(format!("<vibrissa.{name} from {:?} to {:?}>", path.start(), path.end()))
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        if let Some(constructor) = &self.constructor {
            return Ok(constructor.reduce(py));
        }
        // of a scene: start and end of a straight leg, or pivot and angle
        let leg = |leg: &Leg| match *leg {
            Leg::Straight { path, to } => (tuple(path.at(0.0)), tuple(to)).into_pyobject(py),
            Leg::Pivot { pivot, turn, .. } => (pivot, turn).into_pyobject(py),
        };
        let legs: Vec<_> = self.legs.iter().flatten().map(leg).collect::<PyResult<_>>()?;
        Ok((py.import("vibrissa._pickled")?.getattr("path")?, (legs,).into_pyobject(py)?))
    }
}

/// A straight path, on which the clamp turns in proportion to the way.
///
/// Its parameter is the way of the clamp in m, or the angle in rad where the clamp only turns.
///
/// Parameters
/// ----------
/// start, end : tuple of float
///     Poses of the clamp: x (m), y (m), phi (rad).
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, an angle is larger than 100 rad, or the poses are equal.
#[pyclass(frozen, extends = PyPath, name = "ClampPath", module = "vibrissa")]
pub struct PyClampPath;

#[pymethods]
impl PyClampPath {
    #[new]
    fn new(py: Python<'_>, start: PyPose, end: PyPose) -> PyResult<(Self, PyPath)> {
        let path = ClampPath::new(start.0, end.0).map_err(errors::value)?;
        let legs = vec![Leg::Straight { path, to: end.0 }];
        let (start, end) = (tuple(start.0), tuple(end.0));
        let constructor = constructor!(py, "ClampPath", start, end);
        Ok((Self, PyPath::new(path, Some(legs), Some(constructor))))
    }
}

/// A path along a circular arc, on which the clamp turns with the arc, as about a pivot, or on its own.
///
/// Its parameter is the way of the clamp in m, or the angle in rad where the clamp is at the centre.
///
/// Parameters
/// ----------
/// start : tuple of float
///     First pose of the clamp: x (m), y (m), phi (rad).
/// center : tuple of float
///     Centre of the arc, or the pivot, in m.
/// turn : float
///     Angle of the arc in rad, counter-clockwise.
/// phi_end : float, optional
///     Angle of the clamp at the end in rad; without it the clamp turns with the arc.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, an angle is larger than 100 rad, or nothing moves.
#[pyclass(frozen, extends = PyPath, name = "ClampArc", module = "vibrissa")]
pub struct PyClampArc;

#[pymethods]
impl PyClampArc {
    #[new]
    #[pyo3(signature = (start, center, turn, phi_end=None))]
    fn new(
        py: Python<'_>,
        start: PyPose,
        #[pyo3(from_py_with = two)] center: [f64; 2],
        turn: f64,
        phi_end: Option<f64>,
    ) -> PyResult<(Self, PyPath)> {
        let path = match phi_end {
            Some(phi) => ClampArc::new(start.0, center, turn, phi),
            None => ClampArc::about(start.0, center, turn),
        };
        let path = path.map_err(errors::value)?;
        let leg = Leg::Pivot { path, pivot: center, turn };
        let start = tuple(start.0);
        let constructor = constructor!(py, "ClampArc", start, center, turn, phi_end);
        Ok((Self, PyPath::new(path, phi_end.is_none().then(|| vec![leg]), Some(constructor))))
    }
}

/// A natural cubic spline through poses.
///
/// Its parameter is the length of the polygon through the poses in m, or the angle in rad where the clamp only turns.
///
/// Parameters
/// ----------
/// poses : sequence of tuples of float
///     Two or more poses of the clamp: x (m), y (m), phi (rad).
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, an angle is larger than 100 rad, there are fewer than two poses, or two neighbours have the
///     same position.
#[pyclass(frozen, extends = PyPath, name = "ClampSpline", module = "vibrissa")]
pub struct PyClampSpline;

#[pymethods]
impl PyClampSpline {
    #[new]
    fn new(py: Python<'_>, poses: Vec<PyPose>) -> PyResult<(Self, PyPath)> {
        let poses: Vec<Pose> = poses.into_iter().map(|pose| pose.0).collect();
        let path = ClampSpline::through(&poses).map_err(errors::value)?;
        let poses: Vec<_> = poses.into_iter().map(tuple).collect();
        Ok((Self, PyPath::new(path, None, Some(constructor!(py, "ClampSpline", poses)))))
    }
}

/// Paths one after another, each from where the one before ends.
///
/// The last pose of each leg is reported, and states tell their leg.
///
/// Parameters
/// ----------
/// legs : sequence of Path
///     The legs in order.
///
/// Raises
/// ------
/// ValueError
///     There are no legs, or a leg does not begin where the one before ends.
#[pyclass(frozen, extends = PyPath, name = "Chain", module = "vibrissa")]
pub struct PyChain;

#[pymethods]
impl PyChain {
    #[new]
    fn new(py: Python<'_>, legs: Vec<Bound<'_, PyPath>>) -> PyResult<(Self, PyPath)> {
        let path = Chain::new(legs.iter().map(|leg| leg.get().path.clone()).collect()).map_err(errors::value)?;
        let written: Option<Vec<_>> = legs.iter().map(|leg| leg.get().legs.clone()).collect();
        let constructor = constructor!(py, "Chain", legs);
        Ok((Self, PyPath::new(path, written.map(|legs| legs.concat()), Some(constructor))))
    }

    /// Straight legs from pose to pose.
    ///
    /// Parameters
    /// ----------
    /// poses : sequence of tuples of float
    ///     Two or more poses of the clamp: x (m), y (m), phi (rad).
    ///
    /// Returns
    /// -------
    /// Chain
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     As for :class:`ClampPath`; there are fewer than two poses.
    #[staticmethod]
    fn polyline(py: Python<'_>, poses: Vec<PyPose>) -> PyResult<Py<Self>> {
        let poses: Vec<Pose> = poses.into_iter().map(|pose| pose.0).collect();
        let path = Chain::polyline(&poses).map_err(errors::value)?;
        let given: Vec<_> = poses.iter().copied().map(tuple).collect();
        let constructor = Constructor::method(&py.get_type::<Self>(), "polyline", (given,))?;
        let leg = |pair: &[Pose]| ClampPath::new(pair[0], pair[1]).map(|path| Leg::Straight { path, to: pair[1] });
        let legs = poses.windows(2).map(leg).collect::<Result<_, _>>().map_err(errors::value)?;
        Py::new(py, (Self, PyPath::new(path, Some(legs), Some(constructor))))
    }
}
