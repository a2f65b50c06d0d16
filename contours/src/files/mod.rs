//! Contours as data: files of points, paths and shapes, and the shapes by the names of their fields.

mod csv;
pub mod description;
mod error;
mod json;
mod path;
mod svg;

use std::io::{self, ErrorKind};
use std::path::Path;

use error::{FileError, SvgError};

/// Contours from files: points from CSV, paths from SVG, whole contours from JSON. Feature `files`.
pub mod file {
    pub use super::csv::points;
    pub use super::error::{FileError, SvgError};
    pub use super::json::{contour, shapes};
    pub use super::path::subpaths;
    pub use super::svg::data as svg_data;
}

fn text(file: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(file).map_err(|source| {
        let source = match source.kind() {
            ErrorKind::InvalidData => io::Error::new(ErrorKind::InvalidData, "it is no text in UTF-8"),
            _ => source,
        };
        FileError::Unreadable { file: file.to_path_buf(), source }
    })
}
