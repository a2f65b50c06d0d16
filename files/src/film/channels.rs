//! Measured numbers at the base from a table with any of the columns of a recording.

use super::error::FilmError;
use super::table::{Numbers, is_deviation};
use vibrissa::reconstruct::{Axis, Channel, Measurand};

const EXPECTED: &str = "frame, x, y for points on the rod, or measured numbers: any of x0, y0, phi0 (pose of the support), base_x, base_y, base_phi (of the base), f0x, f0y, m0z, kappa@S (curvature at the arc \
     length S in m), each perhaps with a column sigma_...";

/// Standard deviation of a position (m, as a share of the length of the rod) and angle (rad) that no column tells: as good as
/// exact beside what stages are.
const EXACT: f64 = 1e-6;
/// Standard deviation of a reaction or curvature that no column tells, as a share of the largest one: rows need not be neighbours in time, so that
/// their scatter says nothing.
const SHARE: f64 = 1e-3;

/// A column of measured numbers with its standard deviations, none where a cell has none.
struct Column {
    quantity: Measurand,
    cells: Vec<Option<(f64, Option<f64>)>>,
}

/// The measured numbers of each row, with the number of its frame: that of its column `frame`, or of the row, from 0.
pub(super) fn channels(mut table: Numbers, length: f64) -> Result<Vec<(i64, Vec<Channel>)>, FilmError> {
    let named: Vec<(usize, Measurand, Option<usize>)> = table
        .names()
        .iter()
        .enumerate()
        .filter_map(|(column, name)| Some((column, quantity(name)?, table.column(&format!("sigma_{name}")))))
        .collect();
    if named.is_empty() {
        return Err(FilmError::Missing {
            file: table.file.clone(),
            missing: "of a measured number".into(),
            found: table.names().join(", "),
            expected: EXPECTED,
        });
    }
    let number = table.column("frame");
    let numbers: Vec<Option<i64>> =
        (0..table.len()).map(|row| number.map_or(Some(row as i64), |column| table.whole(row, column))).collect();
    let columns: Vec<Column> = named
        .into_iter()
        .map(|(column, quantity, sigma)| {
            let mut cell = |row: usize| {
                let value = table.number(row, column);
                let sigma = sigma.and_then(|sigma| table.number(row, sigma));
                if sigma.is_some_and(|sigma| !is_deviation(sigma)) {
                    table.fault(row, &format!("sigma_{} is not larger than 0, {DEVIATION}", table.names()[column]));
                }
                value.map(|value| (value, sigma))
            };
            Column { quantity, cells: (0..numbers.len()).map(&mut cell).collect() }
        })
        .collect();
    table.check()?;
    let rows = with_noise(&columns, numbers.len(), length);
    Ok(numbers.into_iter().zip(rows).filter_map(|(number, row)| Some((number?, row))).collect())
}

/// What is expected of a standard deviation.
const DEVIATION: &str = "expected a standard deviation, or nothing";

/// The measured numbers of each row of columns as a table has them, by name; NaN where there is none. Of a rod of `length` (m).
///
/// # Errors
/// Columns of another name or another length, and standard deviations that are none, all at once.
pub fn channels_of_columns(columns: &[(String, Vec<f64>)], length: f64) -> Result<Vec<Vec<Channel>>, String> {
    let count = columns.first().map_or(0, |column| column.1.len());
    let mut faults = Vec::new();
    let mut found = Vec::new();
    for (name, values) in columns {
        if values.len() != count {
            faults.push(format!("{name} has {} rows, expected {count} as {}", values.len(), columns[0].0));
        }
        let base = name.strip_prefix("sigma_").unwrap_or(name);
        let Some(quantity) = quantity(base) else {
            faults.push(format!("{name} is no measured number, expected {EXPECTED}"));
            continue;
        };
        if base != name {
            if values.iter().any(|sigma| !sigma.is_nan() && !is_deviation(*sigma)) {
                faults.push(format!("{name} is not larger than 0 everywhere, {DEVIATION}"));
            }
            if !columns.iter().any(|(other, _)| other == base) {
                faults.push(format!("{name} is given without {base}"));
            }
            continue;
        }
        let sigma = columns.iter().find(|(other, _)| other.strip_prefix("sigma_") == Some(name.as_str()));
        let known = |value: f64| Some(value).filter(|value| !value.is_nan());
        let cell = |(row, value): (usize, &f64)| {
            let sigma = sigma.and_then(|(_, sigmas)| sigmas.get(row).copied().and_then(known));
            known(*value).map(|value| (value, sigma))
        };
        found.push(Column { quantity, cells: values.iter().enumerate().map(cell).collect() });
    }
    if faults.is_empty() { Ok(with_noise(&found, count, length)) } else { Err(faults.join("\n")) }
}

/// The channels of each row; those whose noise no column tells have that of their column.
fn with_noise(columns: &[Column], rows: usize, length: f64) -> Vec<Vec<Channel>> {
    let noise = columns.iter().map(|Column { quantity, cells }| {
        sigma_of(*quantity, &cells.iter().flatten().map(|(value, _)| *value).collect::<Vec<_>>(), length)
    });
    let noise: Vec<f64> = noise.collect();
    let of = |row: usize| {
        let cells = columns.iter().zip(&noise).filter_map(|(Column { quantity, cells }, noise)| {
            let (value, sigma) = cells[row]?;
            Some(Channel { quantity: *quantity, value, sigma: sigma.unwrap_or(*noise) })
        });
        cells.collect()
    };
    (0..rows).map(of).collect()
}

/// What a column measures.
fn quantity(name: &str) -> Option<Measurand> {
    let reaction = |k: usize| Measurand::Reaction(std::array::from_fn(|i| f64::from(u8::from(i == k))));
    Some(match name {
        "x0" => Measurand::Support(Axis::X),
        "y0" => Measurand::Support(Axis::Y),
        "phi0" => Measurand::Support(Axis::Angle),
        "base_x" => Measurand::Base(Axis::X),
        "base_y" => Measurand::Base(Axis::Y),
        "base_phi" => Measurand::Base(Axis::Angle),
        "f0x" => reaction(0),
        "f0y" => reaction(1),
        "m0z" => reaction(2),
        _ => Measurand::Curvature(name.strip_prefix("kappa@")?.parse().ok()?),
    })
}

/// The noise of a channel that no column tells.
fn sigma_of(quantity: Measurand, values: &[f64], length: f64) -> f64 {
    match quantity {
        Measurand::Support(Axis::Angle) | Measurand::Base(Axis::Angle) => return EXACT,
        Measurand::Support(_) | Measurand::Base(_) => return EXACT * length,
        _ => {}
    }
    SHARE * values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()))
}
