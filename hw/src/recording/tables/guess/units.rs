//! The unit of a column, as its name says it or its values suggest it.

use super::summary::ColumnSummary;
use super::words::Quantity;
use super::{Basis, Sureness};
use crate::sample::Unit;
use std::f64::consts::TAU;

/// Range of positions, m, beyond which they are taken for millimetres: no rod here is dragged over 2 m.
const FARTHEST: f64 = 2.0;
/// Step of a time, s, from which on it may be in another unit, and from which on it must: a rate between 0.2 and 2 Hz in s is one
/// between 200 Hz and 2 kHz in ms.
const SLOW: f64 = 0.5;
const SLOWEST: f64 = 5.0;
/// Units of time, and how many of them a second has.
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e3), ("us", 1e6)];
/// Days since 1900 that a spreadsheet shows as dates from 1982 to 2119, and a step in days that a clock in seconds does not have: 2 s.
const DAYS: std::ops::Range<f64> = 3e4..8e4;
const SHORT: f64 = 2e-5;
/// A time in seconds since 1970; in milliseconds, microseconds and nanoseconds it is a thousand times as much each.
const EPOCH: f64 = 1e9;

/// A unit with its reason.
pub(super) struct UnitGuess {
    pub unit: Option<&'static str>,
    pub basis: Basis,
}

/// The unit that values without a stated unit suggest; `None` if they suggest no unit.
pub(super) fn of_values(quantity: Quantity, values: &ColumnSummary) -> UnitGuess {
    let likely = |unit, why: String| UnitGuess { unit: Some(unit), basis: Basis { sureness: Sureness::Likely, why } };
    let open = |why: &str| UnitGuess { unit: None, basis: Basis { sureness: Sureness::Open, why: why.to_owned() } };
    let size = values.size();
    match quantity {
        Quantity::Angle if size > TAU => likely("deg", format!("values up to {size:.4} exceed a turn in radians")),
        Quantity::Angle if size == 0.0 => likely("rad", "0 in every unit".to_owned()),
        Quantity::Angle
            if values.is_constant()
                && size > 0.0
                && (size.to_degrees() % 15.0).min(15.0 - size.to_degrees() % 15.0) < 0.01 =>
        {
            likely("rad", format!("{size:.4} rad is {:.0} degrees", size.to_degrees()))
        }
        Quantity::Angle => open("values within a turn of radians fit radians and degrees"),
        Quantity::Position => of_positions(values, values.range()),
        Quantity::Time if values.numbers == 0 => open("there is no number or date in it"),
        Quantity::Time if DAYS.contains(&values.least) && values.step > 0.0 && values.step < SHORT => {
            likely("day", "values count days from 1900 as a spreadsheet does".to_owned())
        }
        Quantity::Time if size > EPOCH => {
            let power = ((size / EPOCH).log10() / 3.0).floor().clamp(0.0, 3.0);
            likely(["s", "ms", "us", "ns"][power as usize], "values count from 1970".to_owned())
        }
        Quantity::Time if !values.is_growing() => open("the times do not grow"),
        Quantity::Time if (SLOW..SLOWEST).contains(&values.step) => open("the steps fit s and ms"),
        Quantity::Time if values.step > 0.0 => {
            match TIMES.into_iter().find(|(.., second)| values.step < SLOW * second) {
                Some((unit, second)) => likely(
                    unit,
                    format!("steps of {:.4} give {:.4} samples a second", values.step, second / values.step),
                ),
                None => open("the steps fit no usual rate"),
            }
        }
        Quantity::Time => open("the steps fit no usual rate"),
        Quantity::Force => open("values do not distinguish N from mN or counts"),
        Quantity::Torque => open("values do not distinguish N m from N mm or counts"),
        _ => UnitGuess { unit: None, basis: Basis::sure("") },
    }
}

/// The unit of positions that extend over this range at most.
pub(super) fn of_positions(values: &ColumnSummary, range: f64) -> UnitGuess {
    let guess = |unit, sureness, why: String| UnitGuess { unit, basis: Basis { sureness, why } };
    let (least, most, size) = (values.least, values.most, values.size());
    if size == 0.0 {
        guess(Some("m"), Sureness::Likely, "0 in every unit".to_owned())
    } else if range > FARTHEST || size > 10.0 {
        guess(Some("mm"), Sureness::Likely, format!("values from {least:.4} to {most:.4} are too far for metres"))
    } else if range > 0.5 {
        guess(None, Sureness::Open, "values fit m, cm and mm".to_owned())
    } else {
        guess(Some("m"), Sureness::Likely, format!("values from {least:.4} to {most:.4} are too close for millimetres"))
    }
}

/// The unit of this spelling, also where only its capitals are wrong.
pub(super) fn of_spelling(quantity: Quantity, text: &str) -> Option<(&'static str, Basis)> {
    let dimension = quantity.dimension()?;
    if let Ok(unit) = Unit::parse(text, dimension) {
        return Some((unit.name, Basis::sure(format!("[{text}] is written there"))));
    }
    let lower = text.to_lowercase();
    // MN and mN differ by nine orders of magnitude, Deg and deg by nothing
    let unit =
        Unit::parse(&lower, dimension).ok().filter(|_| quantity == Quantity::Angle || quantity == Quantity::Time)?;
    Some((
        unit.name,
        Basis { sureness: Sureness::Likely, why: format!("[{text}] is {} apart from upper and lower case", unit.name) },
    ))
}
