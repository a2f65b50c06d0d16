//! The contact point of each sample, as if it had a single contact.

use crate::array::{Column, Get, structured};
use crate::rod::PyRod;
use crate::running;
use crate::samples::Samples;
use pyo3::prelude::*;
use std::borrow::Cow;
use vibrissa::Sample;
use vibrissa::reconstruct::nalgebra::Matrix3;
use vibrissa::reconstruct::{OneSample, Touch, one_sample, single as invert};
use vibrissa::rod::Reactions;

/// A point, where there is one, whether a single contact gives such reactions, and of which kind.
struct SinglePoint {
    touch: Option<Touch>,
    fits: bool,
    kind: Cow<'static, str>,
}

impl SinglePoint {
    fn of(&self, number: impl Fn(&Touch) -> f64) -> f64 {
        self.touch.as_ref().map_or(f64::NAN, number)
    }
}

const POINT: &[Column<SinglePoint>] = &[
    Column { name: "x", get: Get::Float(|point| point.of(|touch| touch.x)) },
    Column { name: "y", get: Get::Float(|point| point.of(|touch| touch.y)) },
    Column { name: "s", get: Get::Float(|point| point.of(|touch| touch.s)) },
    Column { name: "alpha", get: Get::Float(|point| point.of(|touch| touch.alpha)) },
    Column { name: "force", get: Get::Float(|point| point.of(|touch| touch.force)) },
    Column { name: "fits", get: Get::Flag(|point| point.fits) },
    Column { name: "kind", get: Get::Text(|point| point.kind.clone()) },
];

/// The contact point of each sample as if it had a single contact, sample by sample (Merker et al. 2020), and whether it has one.
///
/// With exact reactions of one contact the point is exact to 1e-13 of the length of a uniform rod, and to 1e-12 of any other. Of several
/// contacts it is wrong: by millimetres in a notch. :func:`reconstruct` tells them apart by the whole scan of a uniform rod; on a rod that
/// tapers, ``kind`` does by each sample.
///
/// Parameters
/// ----------
/// rod : Rod
///     Any rod, on any clamp.
/// samples : structured array, data frame, mapping or array of shape (n, 6)
///     As for :func:`reconstruct`.
///
/// Returns
/// -------
/// numpy.ndarray
///     Structured, one row for each sample: ``x``, ``y`` (m), ``s`` (m), ``alpha`` (rad), ``force`` (N), NaN where the reactions give no
///     point; ``fits``: whether a single contact gives such reactions (if not, there are several, or the sensor has an error); ``kind``:
///     ``"free"``, ``"tip"``, ``"tangent"`` (along the side), ``"several"``, or ``"none"`` where the moment vanishes nowhere. Two contacts
///     on a rod that is uniform from the first of them on may give the reactions of ``"tangent"``.
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
    let point = |sample: &Sample| {
        let Sample { pose, reactions, .. } = *sample;
        let covariance = sample.sigma.map_or_else(Matrix3::zeros, |Reactions { f0x, f0y, m0z }| {
            Matrix3::from_diagonal(&[f0x, f0y, m0z].map(|sigma| sigma * sigma).into())
        });
        let one = one_sample(&rod.rod, pose, reactions, &covariance);
        let kind = one.as_ref().map_or(Cow::Borrowed("none"), |one| Cow::Owned(one.to_string()));
        // the closed form of a uniform rod, as in Rust
        let closed = rod.rod.uniform_on_rigid_clamp();
        let closed = closed.map(|rod| invert(rod, pose, reactions, &covariance));
        match (closed, one) {
            (Some(Ok(touch)), _) => SinglePoint { touch: Some(touch), fits: true, kind },
            (Some(Err(none)), _) => SinglePoint { touch: none.touch(), fits: false, kind },
            (None, Ok(one)) => {
                let fits = matches!(one, OneSample::Tip(_) | OneSample::Tangent(_));
                SinglePoint { touch: one.touch(), fits, kind }
            }
            (None, Err(_)) => SinglePoint { touch: None, fits: false, kind },
        }
    };
    let points = running::run(py, || samples.0.iter().map(point).collect::<Vec<_>>())?;
    structured(py, POINT, points.iter())
}
