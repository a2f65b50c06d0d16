//! Why a command fails.

use crate::{
    BudgetError, CalibrateError, FakeError, FigureError, LiveError, OutputError, ProfileError, ReconstructionError,
    RecordingError, SceneError, SimulationError, StudyError, TruthError,
};
use vibrissa::contact::ContactError;
use vibrissa::reconstruct::NoiseError;

/// An option that the rod or the scene does not allow.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option}: {why}")]
pub struct OptionError {
    /// Its name, as `--setup`.
    pub option: &'static str,
    /// Why, and what is expected instead.
    pub why: String,
}

/// Why a command fails.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum Error {
    /// The scene, or another TOML file.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The sweep it asks for.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The reconstruction of a recording.
    #[error(transparent)]
    Reconstruct(#[from] vibrissa::reconstruct::ReconstructError),
    /// What is asked of its contours.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A noise model.
    #[error(transparent)]
    Noise(#[from] NoiseError),
    /// How a recording is to be made.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A sensor that is played.
    #[error(transparent)]
    Fake(#[from] FakeError),
    /// A live scan.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// A recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// What a recording tells.
    #[error(transparent)]
    Reconstruction(#[from] ReconstructionError),
    /// The scene that a recording is said to be of.
    #[error(transparent)]
    Truth(#[from] TruthError),
    /// An option that does not apply.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// The accuracy that a scene allows.
    #[error(transparent)]
    Budget(#[from] BudgetError),
    /// A calibration.
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    /// The results of a study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The files.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Error {
    /// Whether the value of an option is wrong, as opposed to a file or a device.
    pub fn is_of_options(&self) -> bool {
        matches!(
            self,
            Self::Profile(_)
                | Self::Option(_)
                | Self::Simulation(_)
                | Self::Study(StudyError::NoScene { .. })
                | Self::Fake(FakeError::Pace { .. } | FakeError::NoPty { .. })
                | Self::Output(OutputError::Name { .. } | OutputError::NoFile { .. })
        )
    }
}
