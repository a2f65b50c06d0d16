//! A scene to begin with.

use rod_files::OutputError;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// A commented scene that can be swept as it is.
pub const FIRST_SCENE: &str = include_str!("scene.toml");

/// Writes [`FIRST_SCENE`] to a new file.
///
/// # Errors
/// [`OutputError::Exists`] where there is a file, a link or anything else of this name; [`OutputError::File`].
pub fn write_first_scene(file: &Path) -> Result<(), OutputError> {
    let failed = |source: std::io::Error| match source.kind() {
        ErrorKind::AlreadyExists => OutputError::Exists { file: file.to_path_buf() },
        _ => OutputError::File { file: file.to_path_buf(), source },
    };
    let mut new = OpenOptions::new().write(true).create_new(true).open(file).map_err(failed)?;
    new.write_all(FIRST_SCENE.as_bytes()).map_err(failed)
}
