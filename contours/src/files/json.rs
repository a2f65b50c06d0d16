//! Contours as lists of shapes.

use std::path::Path;

use super::FileError;
use crate::Composite;
use crate::description::{Pieces, Shape};

/// The shapes of a JSON file: a list of objects, each with the shape's name as `shape` and its fields.
///
/// # Errors
///
/// [`FileError::Unreadable`], or [`FileError::Malformed`] with the line.
pub fn shapes(file: &Path) -> Result<Vec<Shape>, FileError> {
    serde_json::from_str(&super::text(file)?).map_err(|error| {
        let message = error.to_string();
        // The place stands before the message, as for other files.
        let message = message.split(" at line ").next().unwrap_or_default();
        let plain = [
            ("unknown variant", "the shape is"),
            ("invalid type:", "the value is"),
            ("expected f64", "expected a number"),
        ];
        let message = plain.into_iter().fold(message.to_owned(), |message, (rust, plain)| message.replace(rust, plain));
        FileError::Malformed { file: file.to_path_buf(), line: error.line().max(1) as u64, message }
    })
}

/// The contour of a JSON file: its [`shapes`] in order, [joined](Composite::joined). Files that the shapes name are looked
/// for beside it.
///
/// ```
/// let directory = std::env::temp_dir().join("rod-contours-contour");
/// std::fs::create_dir_all(&directory)?;
/// let file = directory.join("lens.json");
/// let lens = r#"[
///     {"shape": "arc", "center": [0, 1], "radius": 1, "from_angle": -150, "to_angle": -30},
///     {"shape": "arc", "center": [0, 0], "radius": 1, "from_angle": 30, "to_angle": 150}
/// ]"#;
/// std::fs::write(&file, lens)?;
/// let lens = rod_contours::file::contour(&file)?;
/// assert!(lens.is_closed() && !lens.is_cavity());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of [`shapes`], [`FileError::Shape`] with the number of the shape, [`FileError::Contour`] where they cannot be
/// joined.
pub fn contour(file: &Path) -> Result<Composite, FileError> {
    let directory = file.parent().unwrap_or("".as_ref());
    let mut pieces = Pieces::new();
    for (index, shape) in shapes(file)?.iter().enumerate() {
        pieces.extend(shape.pieces(directory).map_err(|source| FileError::Shape {
            file: file.to_path_buf(),
            shape: index + 1,
            source: Box::new(source),
        })?);
    }
    Composite::joined(pieces).map_err(|source| FileError::Contour { file: file.to_path_buf(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("object.json");
        std::fs::write(&file, text).unwrap();
        contour(&file).unwrap_err().to_string().replace(directory.path().to_str().unwrap(), "")
    }

    #[test]
    fn what_is_no_contour() {
        assert_eq!(message("[]"), "/object.json: a composite contour needs at least one piece, got none");
        assert!(message("[\n{]").starts_with("/object.json:2: "));
        let error = message(r#"[{"shape": "line", "from": [0, 0]}]"#);
        assert_eq!(error, "/object.json:1: missing field `to`");
        let error = message(r#"[{"shape": "arc", "center": [0, 0], "radius": -1, "from_angle": 0, "to_angle": 9}]"#);
        assert_eq!(error, "/object.json: shape 1, radius: the arc's radius is -1, expected a positive number");
        let error = message(r#"[{"shape": "polygon", "file": "points.csv"}]"#);
        assert!(error.starts_with("/object.json: shape 1, file: cannot read /points.csv: "), "{error}");
    }
}
