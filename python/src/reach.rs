//! What scans can touch.

use crate::array::{Column, Floats, Get, structured};
use crate::composite::contours;
use crate::scene::PyScene;
use crate::{errors, running};
use pyo3::prelude::*;
use rod_files::{OutlinePart, Reached};
use std::borrow::Cow;
use vibrissa::contact::Path;
use vibrissa::plan::{IntervalSet, ScanReach};

/// A scan, and the share of the outlines that it touches.
struct Row {
    one: ScanReach,
    share: f64,
}

fn length(sets: &[IntervalSet]) -> f64 {
    sets.iter().map(IntervalSet::length).sum()
}

const SCANS: &[Column<Row>] = &[
    Column { name: "angle", get: Get::Float(|row| row.one.scan.angle) },
    Column { name: "distance", get: Get::Float(|row| row.one.scan.distance) },
    Column { name: "pass", get: Get::Text(|row| Cow::Owned(row.one.scan.pass.to_string())) },
    Column { name: "single", get: Get::Float(|row| length(&row.one.found.touched.single)) },
    Column { name: "several", get: Get::Float(|row| length(&row.one.found.touched.several)) },
    Column { name: "touched_share", get: Get::Float(|row| row.share) },
    Column { name: "snaps", get: Get::Int(|row| row.one.found.snaps as i64) },
    Column { name: "largest_moment", get: Get::Float(|row| row.one.found.largest_moment) },
    Column { name: "largest_stress", get: Get::Float(|row| row.one.found.largest_stress.unwrap_or(f64::NAN)) },
    Column {
        name: "reason",
        get: Get::Text(|row| {
            row.one.found.stop.as_ref().map_or(Cow::Borrowed(""), |stop| Cow::Owned(stop.to_string()))
        }),
    },
];

const PARTS: &[Column<OutlinePart>] = &[
    Column { name: "object", get: Get::Int(|part| part.object as i64) },
    Column { name: "start", get: Get::Float(|part| part.from) },
    Column { name: "end", get: Get::Float(|part| part.to) },
    Column { name: "how", get: Get::Text(|part| Cow::Owned(part.touch.to_string())) },
    Column { name: "x_start", get: Get::Float(|part| part.ends[0][0]) },
    Column { name: "y_start", get: Get::Float(|part| part.ends[0][1]) },
    Column { name: "x_end", get: Get::Float(|part| part.ends[1][0]) },
    Column { name: "y_end", get: Get::Float(|part| part.ends[1][1]) },
];

/// A line of an outline: how it is touched, and its points x, y (m).
type Line = (String, Vec<[f64; 2]>);

/// The scans, the parts of the outline, its length (m), and the lines of its parts.
type Tables<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, f64, Vec<Line>);

/// The tables of :func:`vibrissa.reach`, the length of all outlines, and the lines of their parts.
#[pyfunction]
pub fn _reach<'py>(
    scene: &Bound<'py, PyScene>,
    distances: Option<Floats<'py>>,
    angles: Option<Floats<'py>>,
) -> PyResult<Tables<'py>> {
    let (py, scene) = (scene.py(), scene.get());
    if scene.friction.is_some() {
        return Err(errors::value("the scene has friction, expected none: reach computes contacts without friction"));
    }
    let objects: Vec<_> = scene.objects.iter().map(|object| object.bind(py).clone()).collect();
    let objects = contours(&objects);
    let rod = &scene.rod.get().rod;
    let [distances, angles] =
        [distances, angles].map(|values| values.map(|values| values.view().iter().copied().collect::<Vec<f64>>()));
    let path = scene.path.get().shared();
    let angles = angles.unwrap_or_else(|| vec![path.point(0.0).pose.phi]);
    let found = running::interruptible(py, |interrupt| Reached::new("", rod, objects, distances, angles, interrupt))?
        .map_err(errors::value)?;
    let row = |one: &ScanReach| Row { one: one.clone(), share: found.shares_of(&one.found.touched)[1] };
    let rows: Vec<Row> = found.found.scans.iter().map(row).collect();
    let parts = found.outline_parts();
    let line = |part: &OutlinePart| {
        let (shape, outline) = (&found.objects[part.object], &found.found.outlines[part.object]);
        let within = outline.points(shape).filter(|(place, _)| part.from < *place && *place < part.to);
        let within = within.map(|(_, frame)| [frame.x, frame.y]);
        (part.touch.to_string(), [part.ends[0]].into_iter().chain(within).chain([part.ends[1]]).collect())
    };
    let lines = parts.iter().map(line).collect();
    Ok((structured(py, SCANS, rows.iter())?, structured(py, PARTS, parts.iter())?, found.found.length(), lines))
}
