//! The file of a study as written, and what is wrong with it.

use crate::OutputError;
use serde::Deserialize;
use std::io;
use std::path::PathBuf;
use toml::Spanned;

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyDocument {
    pub scene: Spanned<PathBuf>,
    pub parameter: Vec<Spanned<ParameterTable>>,
}

/// `[[parameter]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterTable {
    pub name: Spanned<String>,
    pub values: Option<Spanned<Vec<f64>>>,
    pub from: Option<Spanned<f64>>,
    pub to: Option<Spanned<f64>>,
    pub count: Option<Spanned<usize>>,
    pub set: Vec<Spanned<SetTable>>,
}

/// One of `set`: a number of the scene, offset + scale * value.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SetTable {
    pub field: Spanned<String>,
    #[serde(default)]
    pub offset: f64,
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}
