//! What numbers must be before a contour can be made of them.

use crate::{ContourError, Point, Range};

/// Finite, all of them.
pub(crate) fn finite(numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ContourError> {
    not_finite(numbers).map_or(Ok(()), |(what, value)| Err(ContourError::NotFinite { what, value }))
}

/// Finite, all of what a function gives at `t`.
pub(crate) fn finite_at(t: f64, numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ContourError> {
    not_finite(numbers).map_or(Ok(()), |(what, value)| Err(ContourError::NotFiniteAt { what, t, value }))
}

fn not_finite(numbers: impl IntoIterator<Item = (&'static str, f64)>) -> Option<(&'static str, f64)> {
    numbers.into_iter().find(|(_, value)| !value.is_finite())
}

/// Positive, for a number that is finite.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), ContourError> {
    if value <= 0.0 { Err(ContourError::NotPositive { what, value }) } else { Ok(()) }
}

/// A range with a start before its end, neither of them NaN.
pub(crate) fn range(what: &'static str, Range { from, to }: Range) -> Result<(), ContourError> {
    if from < to { Ok(()) } else { Err(ContourError::EmptyRange { what, from, to }) }
}

/// Finite points.
pub(crate) fn points(points: &[Point]) -> Result<(), ContourError> {
    match points.iter().position(|point| !point.iter().all(|side| side.is_finite())) {
        Some(index) => Err(ContourError::PointNotFinite { point: index + 1, x: points[index][0], y: points[index][1] }),
        None => Ok(()),
    }
}
