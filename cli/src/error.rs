//! Why a command fails.

use rod_files::{
    FilmError, LiveError, OutputError, PlanFileError, ProfileError, ReconstructionError, RecordingError, SceneError,
    SimulationArgument, SimulationError, StudyError, TruthError, quoted,
};
use vibrissa::contact::ContactError;
use vibrissa::hw::recording::{TableError, TableProblem};
use vibrissa::plan::PlanError;
use vibrissa_cli::{BudgetError, CalibrateError, FakeError, PaperError, WriteError};

/// An option that the rod or the scene does not allow.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option}: {why}")]
pub struct OptionError {
    /// Its name, as `--setup`.
    pub option: &'static str,
    /// Why, and what is expected instead.
    pub why: String,
}

/// Why a command fails: the error of each.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum Error {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Sweep(#[from] ContactError),
    #[error(transparent)]
    Contour(#[from] ProfileError),
    #[error(transparent)]
    Simulate(#[from] SimulationError),
    #[error(transparent)]
    SimulationArgument(#[from] SimulationArgument),
    /// An argument with the name of its option.
    #[error("{0}")]
    Named(String),
    #[error(transparent)]
    FakeSensor(#[from] FakeError),
    #[error(transparent)]
    Live(#[from] LiveError),
    #[error(transparent)]
    Reconstruct(#[from] ReconstructionError),
    #[error(transparent)]
    Film(#[from] FilmError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Truth(#[from] TruthError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Budget(#[from] BudgetError),
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    PlanFile(#[from] PlanFileError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Paper(#[from] PaperError),
    #[error(transparent)]
    Option(#[from] OptionError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Error {
    /// What went wrong with a file of results or with standard output, of whichever command.
    pub fn of_output(&self) -> Option<&OutputError> {
        match self {
            Self::Simulate(SimulationError::Output(error))
            | Self::Live(LiveError::Output(error))
            | Self::Study(StudyError::Output(error))
            | Self::Write(WriteError::Output(error))
            | Self::Output(error) => Some(error),
            _ => None,
        }
    }

    /// The table that cannot be read, if this is why the command fails: the name of the file as a shell takes it.
    pub fn unread_table(&self) -> Option<String> {
        let error = match self {
            Self::Live(error) => error,
            Self::Film(FilmError::Missing { file, .. }) => return Some(quoted(&file.display().to_string())),
            _ => return None,
        };
        let file = match error {
            LiveError::Recording(
                RecordingError::Empty { file }
                | RecordingError::Missing { file, .. }
                | RecordingError::Posed { file }
                | RecordingError::Unusable { file, .. }
                | RecordingError::TooFew { file, .. },
            )
            | LiveError::Rate { file }
            | LiveError::StageRow { file, .. }
            | LiveError::StageTable { file, .. } => file.display().to_string(),
            LiveError::Recording(RecordingError::Table(TableError { file, problem, .. }))
            | LiveError::Table(TableError { file, problem, .. })
                if !matches!(problem, TableProblem::Unreadable(_)) =>
            {
                file.clone()
            }
            LiveError::NoSamples { file, .. } => file.clone(),
            _ => return None,
        };
        Some(quoted(&file))
    }

    /// Whether the value of an option is wrong, as opposed to a file or a device.
    pub fn is_of_options(&self) -> bool {
        match self {
            Self::Contour(_)
            | Self::Plan(_)
            | Self::PlanFile(
                PlanFileError::Plan(_)
                | PlanFileError::Explore(_)
                | PlanFileError::NoStress
                | PlanFileError::NoDiameter,
            )
            | Self::Option(_)
            | Self::Film(FilmError::NoSensor { .. }) => true,
            Self::Study(StudyError::NoScene { .. })
            | Self::FakeSensor(FakeError::Pace { .. } | FakeError::NoPty { .. }) => true,
            _ => {
                self.argument().is_some()
                    || matches!(
                        self.of_output(),
                        Some(OutputError::Name { .. } | OutputError::NoFile { .. } | OutputError::IsDirectory { .. })
                    )
            }
        }
    }

    /// The argument of a simulation that is not possible, of whichever command.
    fn argument(&self) -> Option<&SimulationArgument> {
        match self {
            Self::Simulate(SimulationError::Argument(argument))
            | Self::FakeSensor(FakeError::Simulation(SimulationError::Argument(argument)))
            | Self::Budget(BudgetError::Simulation(SimulationError::Argument(argument)))
            | Self::SimulationArgument(argument) => Some(argument),
            _ => None,
        }
    }

    /// The same, with the names of options.
    pub fn named(self) -> Self {
        match self.argument() {
            Some(argument) => Self::Named(argument.message(|name| format!("--{name}"))),
            None => self,
        }
    }
}
