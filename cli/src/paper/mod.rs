//! The nine scans of Merker et al. (2020): three objects at three distances.
//!
//! `scans` are the scenes, `naive` turns a scan back as if there were one contact, `resolved` with both contacts; `figures` and
//! `report` show all scans, and `files` writes them.

mod figures;
mod files;
mod naive;
mod report;
mod resolved;
mod scans;

pub use scans::{Paper, PaperScan};

use crate::{FigureError, WriteError};
use rod_files::{OutputError, SceneError};
use vibrissa::contact::ContactError;
use vibrissa::reconstruct::ReconstructError;

/// Why the scans of the paper cannot be made or written. Of the first three there are none, unless a scene of this crate is no scene.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum PaperError {
    /// A scene.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// Its sweep.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The reconstruction of its reactions.
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
    /// The files of a scan.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A figure of all scans.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The other files.
    #[error(transparent)]
    Output(#[from] OutputError),
}
