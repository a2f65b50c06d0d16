//! Average whiskers.

use crate::errors;
use pyo3::prelude::*;
use rod_files::{Animal, Whisker, WhiskerError};

/// Length, diameters (m), Young's modulus (Pa), sources and coefficient of the parabola (1/m): the arguments of `vibrissa.whiskers.Whisker`.
type Arguments = (f64, f64, f64, f64, String, f64);

/// The average whisker of a rat or mouse.
#[pyfunction]
pub fn _average_whisker(animal: &str, row: &Bound<'_, PyAny>, column: &Bound<'_, PyAny>) -> PyResult<Arguments> {
    let animal = if animal == "rat" { Animal::Rat } else { Animal::Mouse };
    let index = match (row.extract::<usize>(), row.extract::<String>()) {
        (Ok(number), _) => number.checked_sub(1),
        (_, Ok(letter)) => {
            letter.to_uppercase().parse().ok().and_then(|one: char| ('A'..='E').position(|row| row == one))
        }
        _ => None,
    };
    // a column that is no small integer is refused as one that does not exist
    let column_number = column.extract().unwrap_or(u8::MAX);
    match index.map_or(Err(WhiskerError::Row), |index| Whisker::average(animal, index, column_number)) {
        Ok(whisker) => {
            let Whisker { length, base_diameter, tip_diameter, youngs_modulus, curvature_coefficient, .. } = whisker;
            let sources = whisker.sources.to_string();
            Ok((length, base_diameter, tip_diameter, youngs_modulus, sources, curvature_coefficient))
        }
        Err(WhiskerError::Row) => Err(errors::value(format!("row is {}, expected 1 to 5, or 'A' to 'E'", row.repr()?))),
        Err(error) => Err(errors::value(format!("column is {}, {error}", column.repr()?))),
    }
}

/// Mean curvature of a parabola of this coefficient (1/m) and arc length (m), 1/m.
#[pyfunction]
pub fn _mean_curvature(coefficient: f64, length: f64) -> f64 {
    rod_files::mean_curvature(coefficient, length)
}
