//! Checks of the numbers from which contours are made.

use crate::{ContourError, Point, Range};

/// Checks that all of the numbers are finite.
pub(crate) fn finite(numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ContourError> {
    not_finite(numbers).map_or(Ok(()), |(what, value)| Err(ContourError::NotFinite { what, value }))
}

/// Checks that all numbers that a function gives at `t` are finite.
pub(crate) fn finite_at(t: f64, numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ContourError> {
    not_finite(numbers).map_or(Ok(()), |(what, value)| Err(ContourError::NotFiniteAt { what, t, value }))
}

fn not_finite(numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Option<(&'static str, f64)> {
    numbers.into_iter().find(|(_, value)| !value.is_finite())
}

/// Checks that a finite number is positive.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), ContourError> {
    if value <= 0.0 { Err(ContourError::NotPositive { what, value }) } else { Ok(()) }
}

/// Checks that the start of a range lies before its end, and that neither is NaN.
pub(crate) fn range(what: &'static str, Range { from, to }: Range) -> Result<(), ContourError> {
    if from < to { Ok(()) } else { Err(ContourError::EmptyRange { what, from, to }) }
}

/// Checks that the coordinates of all points are finite.
pub(crate) fn points(points: &[Point]) -> Result<(), ContourError> {
    match points.iter().position(|point| !point.iter().all(|side| side.is_finite())) {
        Some(index) => Err(ContourError::PointNotFinite { point: index + 1, x: points[index][0], y: points[index][1] }),
        None => Ok(()),
    }
}
