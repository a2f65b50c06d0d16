//! What a reconstruction knows of the contour, from its fitted.csv.

use super::PlanFileError;
use serde::Deserialize;
use std::path::Path;
use vibrissa::reconstruct::{FittedObject, Knowledge};

/// A row of fitted.csv.
#[derive(Deserialize)]
struct Row {
    object: usize,
    x: f64,
    y: f64,
    known: String,
    sigma: Option<f64>,
    room: Option<f64>,
    vertex: bool,
}

/// The contours in `fitted.csv` of a directory of `vibrissa reconstruct`.
///
/// # Errors
/// [`PlanFileError`].
pub fn read_known_contours(directory: &Path) -> Result<Vec<FittedObject>, PlanFileError> {
    let file = directory.join("fitted.csv");
    let unreadable = |source: csv::Error| match source.kind() {
        csv::ErrorKind::Io(_) => PlanFileError::NoFit { file: file.clone(), source: source.into() },
        _ => PlanFileError::Table { file: file.clone(), reason: source.to_string() },
    };
    let mut table = csv::Reader::from_path(&file).map_err(unreadable)?;
    let mut contours: Vec<FittedObject> = Vec::new();
    let mut last = None;
    // the head is line 1
    for (line, row) in (2..).zip(table.deserialize()) {
        let row: Row = row.map_err(unreadable)?;
        let wrong = |field: &str, value: String, expected: &str| PlanFileError::Table {
            file: file.clone(),
            reason: format!("line {line}: {field} is {value}, expected {expected}"),
        };
        let number = |field: &str, value: Option<f64>| {
            let value = value.unwrap_or(f64::NAN);
            let is_one = value.is_finite() && value >= 0.0;
            if is_one { Ok(value) } else { Err(wrong(field, value.to_string(), "a number, 0 or larger, m")) }
        };
        let known = match row.known.as_str() {
            "touched" => Knowledge::Touched { sigma: number("sigma", row.sigma)? },
            "bounded" => Knowledge::Bounded { room: number("room", row.room)? },
            "unknown" => Knowledge::Unknown,
            other => return Err(wrong("known", other.to_owned(), "touched, bounded or unknown")),
        };
        if !(row.x.is_finite() && row.y.is_finite()) {
            return Err(wrong("x, y", format!("{}, {}", row.x, row.y), "finite numbers, m"));
        }
        if last != Some(row.object) {
            contours.push(FittedObject { points: Vec::new(), vertices: Vec::new(), known: Vec::new() });
            last = Some(row.object);
        }
        if let Some(contour) = contours.last_mut() {
            if row.vertex {
                contour.vertices.push(contour.points.len());
            }
            contour.points.push([row.x, row.y]);
            contour.known.push(known);
        }
    }
    Ok(contours)
}
