//! Measured numbers at the base from a table with any of the columns of a recording.

use super::error::FilmError;
use super::sensor;
use super::table::{Numbers, is_deviation};
use crate::FilmedRod;
use vibrissa::hw::Mounting;
use vibrissa::reconstruct::{Axis, Channel, Measurand};

const EXPECTED: &str = "frame, x, y for points on the rod, or measured numbers: any of x0, y0, phi0 (pose of the support), base_x, base_y, base_phi (of the base), f0x, f0y, m0z, Fx, Fy, Fz, Tx, Ty, Tz (of a sensor), and at the arc length S in m \
     kappa@S (curvature), x@S, y@S, phi@S (position and slope angle of a marker), each perhaps with a column sigma_...";

/// Standard deviation of a position (m, as a share of the length of the rod) and angle (rad) that no column tells: as good as
/// exact beside what stages are.
const EXACT: f64 = 1e-6;
/// Standard deviation of a reaction or curvature that no column tells, as a share of the largest one: rows need not be neighbours in time, so that
/// their scatter says nothing. Of a marker as a share of the length, and in rad: its coordinates depend on the origin.
const SHARE: f64 = 1e-3;
/// Relative rounding of an arc length at the tip.
const ROUNDING: f64 = 1e-9;

/// What a column measures.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    Of(Measurand),
    /// A component of a sensor, by its number.
    Sensor(usize),
}

impl Quantity {
    /// Whether it is in N or N m.
    fn is_load(self) -> bool {
        matches!(self, Self::Of(Measurand::Reaction(_)) | Self::Sensor(_))
    }
}

/// A column of measured numbers with its standard deviations, none where a cell has none.
struct Column {
    name: String,
    quantity: Quantity,
    cells: Vec<Option<(f64, Option<f64>)>>,
}

/// Measured numbers of a table.
pub(super) struct Measured {
    /// Those of each row, with the number of its frame: that of its column `frame`, or of the row, from 0.
    pub rows: Vec<(i64, Vec<Channel>)>,
    /// Columns that are not used.
    pub ignored: Vec<String>,
    /// Whether components of a sensor are among them.
    pub has_sensor: bool,
}

/// The measured numbers of a table.
pub(super) fn channels(mut table: Numbers, rod: &FilmedRod, mounting: &Mounting) -> Result<Measured, FilmError> {
    let length = rod.rod.length();
    let mut named: Vec<(usize, Quantity, Option<usize>)> = Vec::new();
    let mut faults = Vec::new();
    for (column, name) in table.names().iter().enumerate() {
        match quantity(name, length) {
            Ok(Some(quantity)) => named.push((column, quantity, table.column(&format!("sigma_{name}")))),
            Ok(None) => {}
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(FilmError::Columns { file: table.file, faults });
    }
    if named.is_empty() {
        return Err(FilmError::Missing {
            file: table.file.clone(),
            missing: "of a measured number".into(),
            found: table.found(),
            expected: table.expected(EXPECTED),
        });
    }
    let loads = named.iter().filter(|(_, quantity, _)| quantity.is_load());
    let loads: Vec<&str> = loads.map(|(column, ..)| table.names()[*column].as_str()).collect();
    if !rod.is_stiffness_known && !loads.is_empty() {
        return Err(FilmError::NoStiffness { columns: loads.join(", "), file: table.file });
    }
    let number = table.column("frame");
    let is_used = |column: usize| {
        let is_own = |(own, _, sigma): &(usize, Quantity, Option<usize>)| *own == column || *sigma == Some(column);
        Some(column) == number || Some(column) == table.column("t") || named.iter().any(is_own)
    };
    let has_sensor = named.iter().any(|(_, quantity, _)| matches!(quantity, Quantity::Sensor(_)));
    let ignored = table.names_where(|column| !is_used(column));
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
            let cells = (0..numbers.len()).map(&mut cell).collect();
            Column { name: table.names()[column].clone(), quantity, cells }
        })
        .collect();
    table.check()?;
    let rows = with_noise(&columns, numbers.len(), length, mounting)
        .map_err(|fault| FilmError::Columns { file: table.file, faults: vec![fault] })?;
    let rows = numbers.into_iter().zip(rows).filter_map(|(number, row)| Some((number?, row))).collect();
    Ok(Measured { rows, ignored, has_sensor })
}

/// What is expected of a standard deviation.
const DEVIATION: &str = "expected a standard deviation, or nothing";

/// The measured numbers of each row of columns as a table has them, by name; NaN where there is none. Of a rod of `length` (m) and a sensor that
/// sits by `mounting`.
///
/// # Errors
/// Columns of another name or another length, and standard deviations that are none, all at once.
pub fn channels_of_columns(
    columns: &[(String, Vec<f64>)],
    length: f64,
    mounting: &Mounting,
) -> Result<Vec<Vec<Channel>>, String> {
    let count = columns.first().map_or(0, |column| column.1.len());
    let mut faults = Vec::new();
    let mut found = Vec::new();
    for (name, values) in columns {
        if values.len() != count {
            faults.push(format!("{name} has {} rows, expected {count} as {}", values.len(), columns[0].0));
        }
        let base = name.strip_prefix("sigma_").unwrap_or(name);
        let quantity = match quantity(base, length) {
            Ok(Some(quantity)) => quantity,
            Ok(None) => {
                faults.push(format!("{name} is no measured number, expected {EXPECTED}"));
                continue;
            }
            // told of the number itself
            Err(fault) => {
                faults.extend((base == name).then_some(fault));
                continue;
            }
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
        found.push(Column { name: name.clone(), quantity, cells: values.iter().enumerate().map(cell).collect() });
    }
    if faults.is_empty() { with_noise(&found, count, length, mounting) } else { Err(faults.join("\n")) }
}

/// The channels of each row; those whose noise no column tells have that of their column.
fn with_noise(columns: &[Column], rows: usize, length: f64, mounting: &Mounting) -> Result<Vec<Vec<Channel>>, String> {
    for (k, column) in columns.iter().enumerate() {
        if let Some(same) = columns[..k].iter().find(|other| other.quantity == column.quantity) {
            return Err(format!("{} and {} measure the same, expected one of them", same.name, column.name));
        }
    }
    let noise = columns.iter().map(|Column { name, quantity, cells }| {
        let known = cells.iter().flatten();
        let noise = sigma_of(*quantity, &known.clone().map(|(value, _)| *value).collect::<Vec<_>>(), length);
        let is_across = matches!(quantity, Quantity::Sensor(k) if sensor::combination(mounting, *k, 0.0).is_none());
        if noise == 0.0 && !is_across && known.clone().any(|(_, sigma)| sigma.is_none()) {
            return Err(format!("{name} is 0 everywhere, which tells no standard deviation, expected sigma_{name}"));
        }
        Ok(noise)
    });
    let noise: Vec<f64> = noise.collect::<Result<_, _>>()?;
    let turns = sensor::turns(mounting);
    let of = |row: usize| {
        let angle = |of: fn(Axis) -> Measurand| {
            let k = columns.iter().position(|column| column.quantity == Quantity::Of(of(Axis::Angle)))?;
            columns[k].cells[row].map(|(angle, sigma)| (angle, sigma.unwrap_or(noise[k])))
        };
        let phi = angle(Measurand::Support).or_else(|| angle(Measurand::Base));
        let (phi, sigma_phi) = phi.unzip();
        let components = columns.iter().filter(|column| matches!(column.quantity, Quantity::Sensor(0..=2)));
        let force = components.filter_map(|column| column.cells[row]).map(|(part, _)| part * part).sum::<f64>().sqrt();
        let mut channels = Vec::new();
        for (Column { quantity, cells, .. }, noise) in columns.iter().zip(&noise) {
            let Some((value, sigma)) = cells[row] else { continue };
            let mut sigma = sigma.unwrap_or(*noise);
            let quantity = match quantity {
                Quantity::Of(quantity) => Some(*quantity),
                Quantity::Sensor(_) if turns && phi.is_none() => {
                    return Err(format!(
                        "row {row} (from 0): the sensor turns with the clamp, expected phi0 beside its numbers"
                    ));
                }
                Quantity::Sensor(component) => {
                    let of = |phi| sensor::combination(mounting, *component, phi);
                    let phi = phi.unwrap_or_default();
                    // the error of the angle turns the force
                    if let Some(sigma_phi) = sigma_phi.filter(|_| turns) {
                        sigma = sigma.hypot(force * sensor::change(of(phi), of(phi + sigma_phi)));
                    }
                    of(phi)
                }
            };
            // what is across the plane tells nothing
            let Some(quantity) = quantity else { continue };
            channels.push(Channel { quantity, value, sigma });
        }
        Ok(channels)
    };
    (0..rows).map(of).collect()
}

/// What a column measures on a rod of `length` (m): nothing, if it has another name; an error, if it is at no place of the rod.
fn quantity(name: &str, length: f64) -> Result<Option<Quantity>, String> {
    if let Some((kind, place)) = name.split_once('@') {
        let at: fn(f64) -> Measurand = match kind {
            "kappa" => Measurand::Curvature,
            "x" => |s| Measurand::Marker(s, Axis::X),
            "y" => |s| Measurand::Marker(s, Axis::Y),
            "phi" => |s| Measurand::Marker(s, Axis::Angle),
            _ => return Ok(None),
        };
        let is_on_rod = |s: &f64| (0.0..=length * (1.0 + ROUNDING)).contains(s);
        return match place.parse().ok().filter(is_on_rod) {
            Some(s) => Ok(Some(Quantity::Of(at(s)))),
            None => Err(format!(
                "{name} is at `{place}`, expected an arc length in m, from 0 to {length:?}, the length of the rod"
            )),
        };
    }
    if let Some(component) = sensor::component(name) {
        return Ok(Some(Quantity::Sensor(component)));
    }
    let reaction = |k: usize| Measurand::Reaction(std::array::from_fn(|i| f64::from(u8::from(i == k))));
    Ok(Some(Quantity::Of(match name {
        "x0" => Measurand::Support(Axis::X),
        "y0" => Measurand::Support(Axis::Y),
        "phi0" => Measurand::Support(Axis::Angle),
        "base_x" => Measurand::Base(Axis::X),
        "base_y" => Measurand::Base(Axis::Y),
        "base_phi" => Measurand::Base(Axis::Angle),
        "f0x" => reaction(0),
        "f0y" => reaction(1),
        "m0z" => reaction(2),
        _ => return Ok(None),
    })))
}

/// The noise of a channel that no column tells.
fn sigma_of(quantity: Quantity, values: &[f64], length: f64) -> f64 {
    let Quantity::Of(quantity) = quantity else { return share_of_largest(values) };
    match quantity {
        Measurand::Support(Axis::Angle) | Measurand::Base(Axis::Angle) => return EXACT,
        Measurand::Support(_) | Measurand::Base(_) => return EXACT * length,
        Measurand::Marker(_, Axis::Angle) => return SHARE,
        Measurand::Marker(..) => return SHARE * length,
        _ => {}
    }
    share_of_largest(values)
}

fn share_of_largest(values: &[f64]) -> f64 {
    SHARE * values.iter().fold(0.0, |most, value| value.abs().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_are_the_same_or_zero_are_refused() {
        let columns = |names: &[&str], value: f64| -> Vec<(String, Vec<f64>)> {
            names.iter().map(|name| ((*name).to_owned(), vec![value])).collect()
        };
        let of = |names: &[&str], value| channels_of_columns(&columns(names, value), LENGTH, &at_base()).unwrap_err();
        assert_eq!(of(&["x@0.05", "x@0.050"], 1.0), "x@0.05 and x@0.050 measure the same, expected one of them");
        assert!(of(&["f0x"], 0.0).contains("expected sigma_f0x"));
        assert!(channels_of_columns(&columns(&["x0", "phi0"], 0.0), LENGTH, &at_base()).is_ok());
    }

    /// A force of 2 N, whose direction is known to 0.01 rad.
    #[test]
    fn the_error_of_the_angle_turns_a_force() {
        let mounting = at_base().turning_with_clamp(0.0).unwrap();
        let columns =
            [("phi0", 0.3), ("sigma_phi0", 0.01), ("Fx", 2.0), ("sigma_Fx", 1e-3), ("Fy", 0.0), ("sigma_Fy", 1e-3)];
        let columns: Vec<(String, Vec<f64>)> = columns.map(|(name, value)| (name.to_owned(), vec![value])).to_vec();
        let rows = channels_of_columns(&columns, LENGTH, &mounting).unwrap();
        for channel in &rows[0][1..] {
            assert!((channel.sigma - 0.02).abs() < 1e-4, "{channel:?}");
        }
    }

    const LENGTH: f64 = 0.1;

    fn at_base() -> Mounting {
        Mounting::new(vibrissa::hw::Frame::same())
    }

    #[test]
    fn names_say_what_is_measured() {
        for (name, expected) in [
            ("m0z", Some(Measurand::Reaction([0.0, 0.0, 1.0]))),
            ("kappa@0.02", Some(Measurand::Curvature(0.02))),
            ("x@0.03", Some(Measurand::Marker(0.03, Axis::X))),
            ("y@3e-2", Some(Measurand::Marker(0.03, Axis::Y))),
            ("phi@0.1", Some(Measurand::Marker(0.1, Axis::Angle))),
            ("phi@0", Some(Measurand::Marker(0.0, Axis::Angle))),
            ("f@0.1", None),
            ("x", None),
        ] {
            assert_eq!(quantity(name, LENGTH), Ok(expected.map(Quantity::Of)), "{name}");
        }
    }

    #[test]
    fn what_is_told_is_on_the_rod() {
        let given = |name: &str| (name.to_owned(), vec![0.1]);
        let wrong = ["x@0.2", "kappa@-0.01", "phi@tip", "y@nan", "sigma_x@0.2", "m0z", "force"];
        let faults = channels_of_columns(&wrong.map(given), LENGTH, &at_base()).unwrap_err();
        let faults: Vec<&str> = faults.lines().collect();
        assert_eq!(faults.len(), 5, "{faults:?}");
        for (fault, name) in
            faults.iter().zip(["x@0.2 is at `0.2`", "kappa@-0.01 is at", "phi@tip is at", "y@nan is at"])
        {
            assert!(fault.starts_with(name) && fault.contains("from 0 to 0.1, the length of the rod"), "{fault}");
        }
        assert!(faults[4].starts_with("force is no measured number, expected frame, x, y"), "{}", faults[4]);
    }

    #[test]
    fn a_sensor_that_turns_needs_the_angle_of_the_clamp() {
        let turning = at_base().turning_with_clamp(0.0).unwrap();
        let column = |name: &str| (name.to_owned(), vec![0.5]);
        let rows = channels_of_columns(&["Fx", "Fz", "phi0"].map(column), LENGTH, &turning).unwrap();
        // across the plane is nothing
        assert_eq!(rows[0].len(), 2, "{rows:?}");
        let Measurand::Reaction([x, y, moment]) = rows[0][0].quantity else { panic!("{rows:?}") };
        assert!((x + 0.5_f64.cos()).abs() + (y + 0.5_f64.sin()).abs() + moment.abs() < 1e-15, "{rows:?}");
        let fault = channels_of_columns(&["Fx"].map(column), LENGTH, &turning).unwrap_err();
        assert!(fault.contains("turns with the clamp, expected phi0"), "{fault}");
        assert_eq!(channels_of_columns(&["Fx"].map(column), LENGTH, &at_base()).unwrap()[0].len(), 1);
    }

    #[test]
    fn markers_without_a_deviation_have_a_thousandth_of_the_length() {
        let columns =
            [("x@0.05", vec![7.0]), ("phi@0.05", vec![0.3]), ("y@0.05", vec![1.0]), ("sigma_y@0.05", vec![2e-5])];
        let columns = columns.map(|(name, values)| (name.to_owned(), values));
        let rows = channels_of_columns(&columns, LENGTH, &at_base()).unwrap();
        let sigmas: Vec<f64> = rows[0].iter().map(|channel| channel.sigma).collect();
        assert_eq!(sigmas, [1e-3 * LENGTH, 1e-3, 2e-5]);
    }
}
