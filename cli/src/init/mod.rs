//! Scenes to begin with.

mod whisker;

use rod_files::{OutputError, Whisker};
use std::borrow::Cow;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// A commented scene that can be swept as it is.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum FirstScene {
    /// A rod past an ellipse.
    #[default]
    Ellipse,
    /// A rod past a polygon.
    Polygon,
    /// A whisker that turns past a peg and back.
    Whisking,
    /// A scene with the commands that simulate a recording and reconstruct the object.
    Recording,
    /// An average whisker of a rat or mouse that turns past a peg and back.
    Whisker(Whisker),
}

impl FirstScene {
    /// The text of the scene file.
    ///
    /// ```
    /// use vibrissa_cli::FirstScene;
    /// assert!(FirstScene::Whisking.text().contains("pivot"));
    /// ```
    pub fn text(&self) -> Cow<'static, str> {
        Cow::Borrowed(match self {
            Self::Ellipse => include_str!("scene.toml"),
            Self::Polygon => include_str!("polygon.toml"),
            Self::Whisking => include_str!("whisking.toml"),
            Self::Recording => include_str!("recording.toml"),
            Self::Whisker(whisker) => return Cow::Owned(whisker::scene(whisker)),
        })
    }

    /// Writes it to a new file.
    ///
    /// # Errors
    /// [`OutputError::Exists`] where there is a file, a link or anything else of this name; [`OutputError::File`].
    pub fn write(&self, file: &Path) -> Result<(), OutputError> {
        let failed = |source: std::io::Error| match source.kind() {
            ErrorKind::AlreadyExists => OutputError::Exists { file: file.to_path_buf() },
            _ => OutputError::File { file: file.to_path_buf(), source },
        };
        let mut new = OpenOptions::new().write(true).create_new(true).open(file).map_err(failed)?;
        new.write_all(self.text().as_bytes()).map_err(failed)
    }
}
