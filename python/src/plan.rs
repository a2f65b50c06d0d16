//! Which scans to make next.

use crate::array::{Column, Floats, Get, structured, whole};
use crate::path::PyPath;
use crate::reconstruct::PyReconstruction;
use crate::simulate::model;
use crate::{errors, running};
use pyo3::prelude::*;
use rod_files::{LargestStress, PlanRequest, Planned, PlannedScan};
use std::borrow::Cow;
use vibrissa::Pose;
use vibrissa::plan::Candidate;

const CANDIDATES: &[Column<PlannedScan>] = &[
    Column { name: "candidate", get: Get::Int(|row| row.candidate as i64) },
    Column { name: "chosen", get: Get::Int(|row| row.chosen.unwrap_or(0) as i64) },
    Column { name: "angle", get: Get::Float(|row| row.from.phi) },
    Column { name: "distance", get: Get::Float(|row| row.scan.map_or(f64::NAN, |scan| scan.distance)) },
    Column {
        name: "pass",
        get: Get::Text(|row| row.scan.map_or(Cow::Borrowed(""), |scan| Cow::Owned(scan.pass.to_string()))),
    },
    Column { name: "x_from", get: Get::Float(|row| row.from.x) },
    Column { name: "y_from", get: Get::Float(|row| row.from.y) },
    Column { name: "x_to", get: Get::Float(|row| row.to.x) },
    Column { name: "y_to", get: Get::Float(|row| row.to.y) },
    Column { name: "gain", get: Get::Float(|row| row.gain.map_or(f64::NAN, |gain| gain.mean)) },
    Column { name: "gain_sigma", get: Get::Float(|row| row.gain.map_or(f64::NAN, |gain| gain.sigma)) },
    Column { name: "touched", get: Get::Float(|row| row.gain.map_or(f64::NAN, |gain| gain.touched)) },
    Column { name: "time", get: Get::Float(|row| row.time) },
    Column { name: "largest_moment", get: Get::Float(|row| row.largest_moment) },
    Column { name: "largest_stress", get: Get::Float(|row| row.largest_stress.unwrap_or(f64::NAN)) },
    Column { name: "blocked", get: Get::Flag(|row| row.is_blocked) },
    Column { name: "swept", get: Get::Int(|row| row.swept as i64) },
    Column { name: "sigma", get: Get::Float(|row| row.sigma.unwrap_or(f64::NAN)) },
    Column { name: "known_sigma_after", get: Get::Float(|row| row.known_sigma_after.unwrap_or(f64::NAN)) },
];

/// The points x, y (m) of an outline.
type Points = Vec<[f64; 2]>;

/// A number that must be positive.
fn positive(what: &str, value: f64, unit: &str) -> PyResult<f64> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(errors::value(format!("{what} is {value} {unit}, expected a positive, finite number")))
}

/// A stress in Pa, or "any".
fn limit(stress: &Bound<'_, PyAny>) -> PyResult<LargestStress> {
    match stress.extract::<f64>() {
        Ok(value) => positive("stress", value, "Pa").map(LargestStress::Given),
        Err(_) if stress.extract::<String>().is_ok_and(|text| text == "any") => Ok(LargestStress::Any),
        Err(_) => Err(errors::value(format!("stress is {stress}, expected a number, Pa, or \"any\""))),
    }
}

/// A scan along a path whose parameter is the way in m.
fn candidate(path: &PyPath) -> PyResult<Candidate> {
    let path = path.path.clone();
    let is_way = |part: f64| {
        let Pose { x, y, .. } = path.point(part * path.length()).rate;
        (x.hypot(y) - 1.0).abs() < 1e-9
    };
    if !(path.legs().is_empty() && [0.0, 0.5, 1.0].into_iter().all(is_way)) {
        let message = "paths has one of which the parameter is not the way of the clamp, expected ClampPath or ClampArc on which it moves";
        return Err(errors::value(message));
    }
    Ok(Candidate { scan: None, path })
}

/// The table of :func:`vibrissa.plan`, and the outlines of the hypotheses.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
pub fn _plan<'py>(
    py: Python<'py>,
    found: &PyReconstruction,
    distances: Option<Floats<'py>>,
    angles: Option<Floats<'py>>,
    paths: Vec<Bound<'py, PyPath>>,
    #[pyo3(from_py_with = whole)] scans: usize,
    stress: Option<&Bound<'py, PyAny>>,
    noise: Option<&Bound<'py, PyAny>>,
    rate: f64,
    speed: f64,
    #[pyo3(from_py_with = whole)] hypotheses: usize,
    #[pyo3(from_py_with = whole)] seed: u64,
) -> PyResult<(Bound<'py, PyAny>, Vec<Points>)> {
    let largest_stress = stress.map_or(Ok(LargestStress::Yield), limit)?;
    for (what, value, unit) in [("rate", rate, "Hz"), ("speed", speed, "m/s")] {
        positive(what, value, unit)?;
    }
    let paths = paths.iter().map(|path| candidate(path.get())).collect::<PyResult<Vec<_>>>()?;
    let found = found.found();
    let fit = found.fitted().ok_or_else(|| {
        errors::value("the reconstruction has no fitted contour, expected one of a recording with noise, without friction, and with fit=True")
    })?;
    let [distances, angles] =
        [distances, angles].map(|values| values.map(|values| values.view().iter().copied().collect::<Vec<f64>>()));
    let noise = noise.map(model).transpose()?;
    let (scans, count) = (Vec::new(), scans);
    let request =
        PlanRequest { distances, angles, scans, paths, noise, rate, speed, count, largest_stress, hypotheses, seed };
    let (rod, known) = (&found.rod, fit.objects.clone());
    let planned = running::interruptible(py, |interrupt| Planned::new("", rod, known, &request, interrupt))?
        .map_err(errors::value)?;
    let outlines = planned.plan.hypotheses.iter().flat_map(|one| one.objects.iter().zip(&one.outlines));
    let points = outlines.map(|(object, outline)| outline.points(object).map(|(_, at)| [at.x, at.y]).collect());
    Ok((structured(py, CANDIDATES, planned.rows().iter())?, points.collect()))
}
