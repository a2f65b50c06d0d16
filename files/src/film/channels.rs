//! Measured numbers at the base from a table with any of the columns of a recording.

use super::error::FilmError;
use super::points::whole;
use super::table::Numbers;
use vibrissa::reconstruct::{Axis, Channel, Measurand};

const EXPECTED: &str = "any of x0, y0, phi0 (pose of the support), base_x, base_y, base_phi (of the base), f0x, f0y, m0z, kappa@S (curvature at the arc \
     length S in m), each perhaps with a column sigma_...";

/// Standard deviation of a position (m, as a share of the length of the rod) and angle (rad) that no column tells, and least one of a reaction, as a
/// share of the largest: as good as exact beside what sensors and stages are.
const EXACT: f64 = 1e-6;
/// Fewest rows from which the noise of a channel is found.
const FEWEST: usize = 8;
/// Standard deviation of a reaction or curvature in a table that is too short to show it, as a share of the largest.
const SHARE: f64 = 1e-3;
/// What third differences of independent noise have as their variance, in that of the noise.
const THIRD: f64 = 20.0;

/// The measured numbers of each row, with the number of its frame: that of its column `frame`, or of the row, from 0.
pub(super) fn channels(mut table: Numbers, length: f64) -> Result<Vec<(i64, Vec<Channel>)>, FilmError> {
    let mut columns = Vec::new();
    for (column, name) in table.names().iter().enumerate() {
        if let Some(quantity) = quantity(name) {
            columns.push((column, quantity, table.column(&format!("sigma_{name}"))));
        }
    }
    if columns.is_empty() {
        return Err(FilmError::Missing {
            file: table.file.clone(),
            missing: "of a measured number".into(),
            found: table.names().join(", "),
            expected: EXPECTED,
        });
    }
    let number = table.column("frame");
    let mut rows = Vec::with_capacity(table.len());
    for row in 0..table.len() {
        let of = match number {
            Some(column) => whole(&mut table, row, column),
            None => Some(row as i64),
        };
        let mut found = Vec::with_capacity(columns.len());
        for (column, quantity, sigma) in &columns {
            let value = table.number(row, *column);
            let sigma = sigma.and_then(|column| table.number(row, column));
            if sigma.is_some_and(|sigma| !(sigma > 0.0 && sigma.is_finite())) {
                let fault = format!(
                    "sigma_{} is not larger than 0, expected a standard deviation, or an empty cell",
                    table.names()[*column]
                );
                table.fault(row, &fault);
            }
            found.push(value.map(|value| (*quantity, value, sigma)));
        }
        rows.extend(of.map(|of| (of, found)));
    }
    table.check()?;
    let noise: Vec<f64> = columns
        .iter()
        .enumerate()
        .map(|(k, (_, quantity, _))| {
            let values = rows.iter().filter_map(|(_, row)| row[k].map(|(_, value, _)| value));
            sigma_of(*quantity, &values.collect::<Vec<_>>(), length)
        })
        .collect();
    let channels = |row: Vec<Option<(Measurand, f64, Option<f64>)>>| {
        let with_noise = row.into_iter().zip(&noise).filter_map(|(cell, noise)| {
            cell.map(|(quantity, value, sigma)| Channel { quantity, value, sigma: sigma.unwrap_or(*noise) })
        });
        with_noise.collect::<Vec<_>>()
    };
    Ok(rows.into_iter().map(|(of, row)| (of, channels(row))).collect())
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

/// The noise of a channel that no column tells: of a pose none, of others what third differences along the table show.
fn sigma_of(quantity: Measurand, values: &[f64], length: f64) -> f64 {
    match quantity {
        Measurand::Support(Axis::Angle) | Measurand::Base(Axis::Angle) => return EXACT,
        Measurand::Support(_) | Measurand::Base(_) => return EXACT * length,
        _ => {}
    }
    let largest = values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    if values.len() < FEWEST {
        return SHARE * largest;
    }
    let third = |v: &[f64]| (v[3] - 3.0 * v[2] + 3.0 * v[1] - v[0]).abs();
    let mut differences: Vec<f64> = values.windows(4).map(third).collect();
    differences.sort_unstable_by(f64::total_cmp);
    // the median of the size of a normal variable
    (differences[differences.len() / 2] / 0.6745 / THIRD.sqrt()).max(EXACT * largest)
}
