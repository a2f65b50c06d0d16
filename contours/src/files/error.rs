//! Errors of files and of the fields of a shape.

use std::path::PathBuf;

use crate::ContourError;

/// Why a file gives no contour.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file cannot be read as text.
    #[error("cannot read {}: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// A table without a column of this name.
    #[error(
        "{}: no column {column} in the header \"{header}\", expected columns named x and y, separated by commas",
        file.display()
    )]
    Column {
        /// The file.
        file: PathBuf,
        /// The column that is missing.
        column: &'static str,
        /// The first line of the file.
        header: String,
    },
    /// A cell of a table that is not a coordinate.
    #[error("{}:{line}: column {column} is \"{text}\", expected a finite number", file.display())]
    Cell {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// The text found there.
        text: String,
    },
    /// A text that is not in the format it should be in.
    #[error("{}:{line}: {message}", file.display())]
    Malformed {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The fault there.
        message: String,
    },
    /// Points that make no contour.
    #[error("{}{}: {source}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Points {
        /// The file.
        file: PathBuf,
        /// Line of the faulty point, from 1, if a single point is at fault.
        line: Option<u64>,
        /// The fault.
        source: ContourError,
    },
    /// A drawing without the requested path.
    #[error("{}: {source}", file.display())]
    Svg {
        /// The file.
        file: PathBuf,
        /// The fault.
        source: SvgError,
    },
    /// A shape of a list.
    #[error(
        "{}: shape {shape}{}: {source}",
        file.display(),
        source.field.map(|field| format!(", {field}")).unwrap_or_default()
    )]
    Shape {
        /// The file.
        file: PathBuf,
        /// Number of the shape, from 1.
        shape: usize,
        /// The fault.
        source: Box<ShapeError>,
    },
    /// Shapes that do not make one contour.
    #[error("{}: {source}", file.display())]
    Contour {
        /// The file.
        file: PathBuf,
        /// The fault.
        source: ContourError,
    },
}

/// Why a drawing, or the data of a path, gives no contour.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SvgError {
    /// No path element.
    #[error("no `path` element, expected one; convert circles, rectangles and text to paths")]
    NoPath,
    /// Several path elements.
    #[error("{count} `path` elements ({ids}), expected one; name one of them with `id`")]
    SeveralPaths {
        /// How many.
        count: usize,
        /// Their ids.
        ids: String,
    },
    /// No path element with this id.
    #[error("no `path` element with the id \"{id}\", expected one of: {ids}")]
    NoSuchPath {
        /// The id.
        id: String,
        /// Those there are.
        ids: String,
    },
    /// A path without data.
    #[error("the `path` element has no attribute `d`, expected the data of the path there")]
    NoData,
    /// An element with a transform.
    #[error(
        "the element `{element}` (of the path, or around it) has the transform \"{transform}\", which is not applied; expected none: let the drawing program apply it to the points"
    )]
    Transform {
        /// Name of the element.
        element: String,
        /// The transform.
        transform: String,
    },
    /// Data that are not a path.
    #[error("the data of the path cannot be read: {message}; expected SVG path data like \"M 0 0 L 1 0\"")]
    Data {
        /// The fault.
        message: String,
    },
    /// A path without a segment of some length.
    #[error("the path is empty, expected at least one line or curve")]
    Empty,
    /// A path with several parts.
    #[error("the path has {count} subpaths, expected one; break it apart and take one of them for each contour")]
    Subpaths {
        /// How many.
        count: usize,
    },
    /// A segment that cannot be part of a contour.
    #[error("segment {segment} of the path: {source}")]
    Segment {
        /// Number of the segment, from 1.
        segment: usize,
        /// The fault.
        source: ContourError,
    },
}

/// Why the fields of a shape make no contour, and which of them is at fault.
#[derive(Debug, thiserror::Error)]
#[error("{fault}")]
pub struct ShapeError {
    /// The field whose value is wrong; `None` if several do not go together, or one is missing.
    pub field: Option<&'static str>,
    /// Which of the field's points, from 1, where it is one of them.
    pub point: Option<usize>,
    /// The fault.
    #[source]
    pub fault: Box<ShapeFault>,
}

/// A fault of the fields of a shape.
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
    pub(crate) fn at(field: &'static str, fault: impl Into<ShapeFault>) -> Self {
        Self { field: Some(field), point: None, fault: Box::new(fault.into()) }
    }

    /// A fault of one field, in words.
    pub(crate) fn says(field: &'static str, message: impl Into<String>) -> Self {
        Self::at(field, ShapeFault::Fields(message.into()))
    }

    /// A fault of the fields together.
    pub(crate) fn of_all(message: impl Into<String>) -> Self {
        Self { field: None, point: None, fault: Box::new(ShapeFault::Fields(message.into())) }
    }

    /// The fault of a shape, at the field that holds the number that is not finite, or else at `otherwise`.
    pub(crate) fn blaming(
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
