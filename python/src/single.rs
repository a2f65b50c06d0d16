//! The contact point of each sample, as if it had a single contact.

use crate::array::{Column, Get, structured};
use crate::rod::PyRod;
use crate::running;
use crate::samples::Samples;
use pyo3::prelude::*;
use vibrissa::reconstruct::nalgebra::Matrix3;
use vibrissa::reconstruct::{Touch, single as invert};

/// A point, where there is one, and whether a single contact gives such reactions.
struct Point {
    touch: Option<Touch>,
    fits: bool,
}

impl Point {
    fn of(&self, number: impl Fn(&Touch) -> f64) -> f64 {
        self.touch.as_ref().map_or(f64::NAN, number)
    }
}

const POINT: &[Column<Point>] = &[
    Column { name: "x", get: Get::Float(|point| point.of(|touch| touch.x)) },
    Column { name: "y", get: Get::Float(|point| point.of(|touch| touch.y)) },
    Column { name: "s", get: Get::Float(|point| point.of(|touch| touch.s)) },
    Column { name: "alpha", get: Get::Float(|point| point.of(|touch| touch.alpha)) },
    Column { name: "force", get: Get::Float(|point| point.of(|touch| touch.force)) },
    Column { name: "fits", get: Get::Flag(|point| point.fits) },
];

/// The contact point of each sample as if it had a single contact, sample by sample (Merker et al. 2020).
///
/// With exact reactions of one contact the point is exact to 1e-13 of the rod's length. Of several contacts it is wrong: by millimetres in a
/// notch. :func:`reconstruct` tells them apart by the whole scan.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// samples : structured array, data frame, mapping or array of shape (n, 6)
///     As for :func:`reconstruct`.
///
/// Returns
/// -------
/// numpy.ndarray
///     Structured, one row for each sample: ``x``, ``y`` (m), ``s`` (m), ``alpha`` (rad), ``force`` (N), NaN where the reactions give no
///     point; ``fits``: whether a single contact gives such reactions (if not, there are several, or the sensor has an error).
///
/// Raises
/// ------
/// ValueError
///     A column is missing, or has another length.
///
/// Examples
/// --------
/// >>> import math, vibrissa
/// >>> rod = vibrissa.Rod(0.1, bending_stiffness=6.3e-4)
/// >>> path = vibrissa.ClampPath((0.05, -0.04, math.pi / 2), (0.0, -0.04, math.pi / 2))
/// >>> circle = vibrissa.CircularArc((0.0, 0.05), 0.03, 0.0, 2.0 * math.pi)
/// >>> scan = vibrissa.sweep(rod, circle, path, 1e-3)
/// >>> points = vibrissa.single(rod, scan.states[-1:])
/// >>> bool(abs(circle.gap(points["x"], points["y"])[0]) < 1e-14)
/// True
#[pyfunction]
pub fn single<'py>(py: Python<'py>, rod: &PyRod, samples: Samples) -> PyResult<Bound<'py, PyAny>> {
    let rod = rod.uniform()?;
    let points = running::run(py, || {
        let point = |sample: &vibrissa::Sample| match invert(rod, sample.pose, sample.reactions, &Matrix3::zeros()) {
            Ok(touch) => Point { touch: Some(touch), fits: true },
            Err(none) => Point { touch: none.touch(), fits: false },
        };
        samples.0.iter().map(point).collect::<Vec<_>>()
    })?;
    structured(py, POINT, points.iter())
}
