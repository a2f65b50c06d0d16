//! What scans can touch.

use crate::array::{Column, Floats, Get, structured};
use crate::composite::contours;
use crate::rod::PyRod;
use crate::{errors, running, sweep};
use pyo3::prelude::*;
use rod_files::{Interrupt, OutlinePart, Reached};
use std::borrow::Cow;
use vibrissa::plan::{IntervalSet, ReachGrid, ScanReach};

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
        name: "stop",
        get: Get::Text(|row| {
            row.one.found.stop.as_ref().map_or(Cow::Borrowed(""), |stop| Cow::Owned(stop.to_string()))
        }),
    },
];

const PARTS: &[Column<OutlinePart>] = &[
    Column { name: "object", get: Get::Int(|part| part.object as i64) },
    Column { name: "start", get: Get::Float(|part| part.from) },
    Column { name: "end", get: Get::Float(|part| part.to) },
    Column { name: "touched", get: Get::Text(|part| Cow::Owned(part.touch.to_string())) },
    Column { name: "x_start", get: Get::Float(|part| part.ends[0][0]) },
    Column { name: "y_start", get: Get::Float(|part| part.ends[0][1]) },
    Column { name: "x_end", get: Get::Float(|part| part.ends[1][0]) },
    Column { name: "y_end", get: Get::Float(|part| part.ends[1][1]) },
];

/// The tables of :func:`vibrissa.reach`, and the length of all outlines.
#[pyfunction]
pub fn _reach<'py>(
    rod: &Bound<'py, PyRod>,
    objects: &Bound<'py, PyAny>,
    distances: Floats<'py>,
    angles: Floats<'py>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, f64)> {
    let py = rod.py();
    let contours = contours(&sweep::objects(objects)?);
    let rod = &rod.get().rod;
    let [distances, angles] = [distances, angles].map(|values| values.view().iter().copied().collect());
    let grid = ReachGrid { distances, angles, ..ReachGrid::of(rod) };
    let interrupt = Interrupt::default();
    let found = running::run(py, || Reached::new("", rod, contours, grid, &interrupt))?.map_err(errors::value)?;
    let row = |one: &ScanReach| Row { one: one.clone(), share: found.shares_of(&one.found.touched)[1] };
    let rows: Vec<Row> = found.found.scans.iter().map(row).collect();
    let parts = found.outline_parts();
    Ok((structured(py, SCANS, rows.iter())?, structured(py, PARTS, parts.iter())?, found.found.length()))
}
