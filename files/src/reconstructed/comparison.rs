//! The result of a comparison with the truth.

use crate::{Scene, SceneError};
use std::path::PathBuf;
use vibrissa::contact::{ContactError, EventKind, Stop};
use vibrissa::reconstruct::score::{Confusion, Deviation, KinkScore};
use vibrissa::{Label, Pose};

/// Why there is no comparison.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum TruthError {
    /// The scene is of another recording.
    #[error("{}: no sample is on the path of the scene {scene}, expected the scene that the recording is of", file.display())]
    Elsewhere {
        /// The recording.
        file: PathBuf,
        /// Name of the scene.
        scene: String,
    },
    /// Its clamp is one of which there are no recordings.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// Its sweep is not possible.
    #[error(transparent)]
    Contact(#[from] ContactError),
}

/// A change of label in the scene, and where it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// The label before.
    pub from: Label,
    /// The label after.
    pub to: Label,
    /// The kind of transition.
    pub kind: EventKind,
    /// The pose of the clamp.
    pub pose: Pose,
    /// Distance along the path of the clamp at which the labels change after it: m, or rad where the clamp only turns. None where no
    /// such change was found nearby.
    pub error: Option<f64>,
}

/// The comparison of a reconstruction with the truth.
#[derive(Debug)]
pub struct Comparison {
    /// The scene.
    pub scene: Scene,
    /// Why its sweep stopped before the end of the path, if it did. Samples beyond are not compared.
    pub stop: Option<Stop>,
    /// Samples that are not on the path of the scene.
    pub off_path: usize,
    /// The phases of the samples on the path.
    pub confusion: Confusion,
    /// Wrong labels within 1e-4 rod lengths of a transition, where they may be either.
    pub either: u64,
    /// Distance from the contour of the points of samples with a single contact.
    pub single: Option<Deviation>,
    /// The same for the first contacts of samples with several.
    pub first: Option<Deviation>,
    /// The same for the second ones.
    pub second: Option<Deviation>,
    /// The same for points that are computed from samples with several contacts as if they had a single one.
    pub naive: Option<Deviation>,
    /// Kinks within 1 mm (or mrad) of transitions that make one: all changes of phase but A -> B, and snaps. For
    /// recall.
    pub kinks: KinkScore,
    /// Kinks within 1 mm (or mrad) of anything that happened, A -> B and borders of pieces included. For precision.
    pub kinks_of_events: KinkScore,
    /// Changes of label.
    pub transitions: Vec<Transition>,
}
