//! Contours from files: points from CSV, paths from SVG, whole contours from JSON. Feature `files`.

mod csv;
mod error;
mod json;
mod path;
mod svg;

pub use csv::points;
pub(crate) use csv::points_with_lines;
pub use error::{FileError, SvgError};
pub use json::{contour, shapes};
pub(crate) use path::piece as svg_piece;
pub use path::subpaths;
pub use svg::data as svg_data;

use std::io::{self, ErrorKind};
use std::path::Path;

fn text(file: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(file).map_err(|source| {
        let source = match source.kind() {
            ErrorKind::InvalidData => io::Error::new(ErrorKind::InvalidData, "it is no text in UTF-8"),
            _ => source,
        };
        FileError::Unreadable { file: file.to_path_buf(), source }
    })
}
