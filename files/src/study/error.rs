//! Errors of a study.

use crate::OutputError;
use std::io;
use std::path::PathBuf;

/// Why a study cannot be run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The directory has the rows of other scenes.
    #[error(
        "{} is of another study, of another scene or of another version; name another directory with --out, or delete it",
        file.display()
    )]
    Another {
        /// Its study.json.
        file: PathBuf,
    },
    /// A scene that the study does not have.
    #[error("--scene is {number}, expected a number from 0 to {last}: the study has so many scenes")]
    NoScene {
        /// Its number.
        number: usize,
        /// The last one.
        last: usize,
    },
    /// A scene cannot be written.
    #[error("scene {number}: {reason}")]
    Field {
        /// Its number.
        number: usize,
        /// Why.
        reason: String,
    },
    /// A file of a part cannot be read or removed.
    #[error("cannot read {}: {source}", file.display())]
    Part {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The files.
    #[error(transparent)]
    Output(#[from] OutputError),
}
