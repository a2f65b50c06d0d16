//! What can be wrong with the fields of a shape.

use crate::ContourError;
use crate::file::{FileError, SvgError};

/// Why a shape's fields make no contour, and which of them is to blame.
#[derive(Debug, thiserror::Error)]
#[error("{fault}")]
pub struct ShapeError {
    /// The field whose value is wrong; none where several do not go together, or one is missing.
    pub field: Option<&'static str>,
    /// Which of the field's points, from 1, where it is one of them.
    pub point: Option<usize>,
    /// What is wrong.
    #[source]
    pub fault: Box<ShapeFault>,
}

/// What is wrong with the fields of a shape.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeFault {
    /// The shape cannot be.
    #[error(transparent)]
    Contour(#[from] ContourError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The data of an SVG path.
    #[error(transparent)]
    Svg(#[from] SvgError),
    /// Fields that do not go together, or a value that none of the others covers.
    #[error("{0}")]
    Fields(String),
}

impl ShapeError {
    /// A fault of one field.
    pub(super) fn at(field: &'static str, fault: impl Into<ShapeFault>) -> Self {
        Self { field: Some(field), point: None, fault: Box::new(fault.into()) }
    }

    /// A fault of one field, in words.
    pub(super) fn says(field: &'static str, message: impl Into<String>) -> Self {
        Self::at(field, ShapeFault::Fields(message.into()))
    }

    /// A fault of the fields together.
    pub(super) fn of_all(message: impl Into<String>) -> Self {
        Self { field: None, point: None, fault: Box::new(ShapeFault::Fields(message.into())) }
    }

    /// The fault of a shape, at the field that holds the number that is not finite, or else at `otherwise`.
    pub(super) fn blaming(
        error: ContourError,
        fields: &[(&'static str, &[f64])],
        otherwise: Option<&'static str>,
    ) -> Self {
        let point = match error {
            ContourError::RepeatedPoint { point, .. } | ContourError::PointNotFinite { point, .. } => Some(point),
            _ => None,
        };
        let field = match error {
            ContourError::NotFinite { value, .. } => fields
                .iter()
                .find(|(_, numbers)| {
                    numbers.iter().any(|number| number.total_cmp(&value).is_eq() || both_nan(*number, value))
                })
                .map(|(field, _)| *field),
            _ => None,
        };
        Self { field: field.or(otherwise), point, fault: Box::new(error.into()) }
    }
}

fn both_nan(one: f64, other: f64) -> bool {
    one.is_nan() && other.is_nan()
}
