//! Samples of a scan: poses of the clamp and its reactions.

use crate::array::{Column, Floats, Get};
use crate::errors;
use pyo3::prelude::*;
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Sample};

const NEEDED: [&str; 6] = ["x0", "y0", "phi0", "f0x", "f0y", "m0z"];
const SIGMAS: [&str; 3] = ["sigma_f0x", "sigma_f0y", "sigma_m0z"];

/// Columns of samples.
pub const SAMPLE: &[Column<Sample>] = &[
    Column { name: "t", get: Get::Float(|sample| sample.t.unwrap_or(f64::NAN)) },
    Column { name: "x0", get: Get::Float(|sample| sample.pose.x) },
    Column { name: "y0", get: Get::Float(|sample| sample.pose.y) },
    Column { name: "phi0", get: Get::Float(|sample| sample.pose.phi) },
    Column { name: "f0x", get: Get::Float(|sample| sample.reactions.f0x) },
    Column { name: "f0y", get: Get::Float(|sample| sample.reactions.f0y) },
    Column { name: "m0z", get: Get::Float(|sample| sample.reactions.m0z) },
    Column { name: "sigma_f0x", get: Get::Float(|sample| sample.sigma.map_or(f64::NAN, |sigma| sigma.f0x)) },
    Column { name: "sigma_f0y", get: Get::Float(|sample| sample.sigma.map_or(f64::NAN, |sigma| sigma.f0y)) },
    Column { name: "sigma_m0z", get: Get::Float(|sample| sample.sigma.map_or(f64::NAN, |sigma| sigma.m0z)) },
];

/// Samples from a table with named columns (a structured array, a data frame, a mapping), or from an array of shape (n, 6).
pub struct Samples(pub Vec<Sample>);

impl<'py> FromPyObject<'py> for Samples {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let names = match object.getattr_opt("dtype")? {
            Some(dtype) if !object.hasattr("columns")? => dtype.getattr("names")?,
            _ if object.hasattr("keys")? => object.call_method0("keys")?,
            _ => object.py().None().into_bound(object.py()),
        };
        if names.is_none() { of_rows(&object.extract()?) } else { of_columns(object, &names) }.map(Self)
    }
}

fn of_columns(table: &Bound<'_, PyAny>, names: &Bound<'_, PyAny>) -> PyResult<Vec<Sample>> {
    let column = |name: &str| -> PyResult<Vec<f64>> {
        if !names.contains(name)? {
            let needed = NEEDED.join(", ");
            return Err(errors::value(format!("the samples have no column {name}, expected {needed}")));
        }
        let floats: Floats<'_> = table.get_item(name)?.extract()?;
        Ok(floats.view().iter().copied().collect())
    };
    let columns = NEEDED.iter().map(|name| column(name)).collect::<PyResult<Vec<_>>>()?;
    let t = if names.contains("t")? { Some(column("t")?) } else { None };
    let sigmas = if names.contains(SIGMAS[0])? {
        Some(SIGMAS.iter().map(|name| column(name)).collect::<PyResult<Vec<_>>>()?)
    } else {
        None
    };
    let n = columns[0].len();
    let all = columns.iter().chain(&t).chain(sigmas.iter().flatten());
    if let Some(other) = all.map(Vec::len).find(|length| *length != n) {
        return Err(errors::value(format!(
            "the columns of the samples have {n} and {other} numbers, expected the same"
        )));
    }
    let sample = |i: usize| {
        let [x, y, phi, f0x, f0y, m0z] = std::array::from_fn(|column| columns[column][i]);
        // NaN stands for what is not known
        let t = t.as_ref().map(|t| t[i]).filter(|t| !t.is_nan());
        let sigma = sigmas.as_ref().map(|sigma| Reactions { f0x: sigma[0][i], f0y: sigma[1][i], m0z: sigma[2][i] });
        let sigma = sigma.filter(|sigma| !sigma.f0x.is_nan());
        Sample { t, pose: Pose { x, y, phi }, reactions: Reactions { f0x, f0y, m0z }, sigma }
    };
    Ok((0..n).map(sample).collect())
}

fn of_rows(rows: &Floats<'_>) -> PyResult<Vec<Sample>> {
    let rows = rows.view();
    let [_, 6] = rows.shape() else {
        let found = rows.shape();
        return Err(errors::value(format!(
            "the samples have shape {found:?}, expected [n, 6]: x0, y0 (m), phi0 (rad), f0x, f0y (N), m0z (N m)"
        )));
    };
    let sample = |row: numpy::ndarray::ArrayViewD<'_, f64>| {
        Sample::new(Pose { x: row[0], y: row[1], phi: row[2] }, Reactions { f0x: row[3], f0y: row[4], m0z: row[5] })
    };
    Ok(rows.outer_iter().map(sample).collect())
}
