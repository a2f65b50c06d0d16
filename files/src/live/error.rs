//! Errors of a live scan.

use crate::{OutputError, RecordingError};
use std::path::PathBuf;
use vibrissa::hw::recording::{RowProblem, TableError};
use vibrissa::hw::{StageError, TareError};
use vibrissa::reconstruct::ReconstructError;

/// Why a live scan cannot start or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The sensor cannot be reached, or its answer is not understood.
    #[error("{address}: {source}")]
    Sensor {
        /// Its address.
        address: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The scale of the sensor's numbers is not known.
    #[error(
        "{address}: the units of its numbers are unknown; give force_unit and torque_unit, and the counts per unit of \
         each if it sends counts, or a calibration or matrix, in the table [sensor] of a setup (--setup FILE)"
    )]
    NoScale {
        /// Its address.
        address: String,
    },
    /// The setup has to choose a part of a recording.
    #[error("{}: expected {field} = .. in the table [recording] of a setup (--setup FILE), of those there are: {found}", file.display())]
    Choose {
        /// Which file.
        file: PathBuf,
        /// The field of the setup that is missing, or names a part that does not exist.
        field: &'static str,
        /// The parts that exist.
        found: String,
    },
    /// The samples have no times.
    #[error(
        "{}: a rate is for TDMS files, a table needs a column of times; name it by time = \"NAME\" in the table [recording] of \
         the setup", file.display()
    )]
    Rate {
        /// Which file.
        file: PathBuf,
    },
    /// A calibration is given for calibrated samples.
    #[error(
        "{}: its wrenches are in N and N m already, expected no calibration, matrix, units or counts in the table [sensor] of \
         the setup", file.display()
    )]
    Calibrated {
        /// Which file.
        file: PathBuf,
    },
    /// A table without samples.
    #[error(
        "{file}{}: found {found}; expected times and reactions (x0, y0, phi0, f0x, f0y, m0z), a wrench (fx to tz) or raw values \
         (channel1, channel2, ...; others by columns = [..] in the table [recording] of a setup)",
        line.map_or_else(String::new, |line| format!(":{line}"))
    )]
    NoSamples {
        /// Which file.
        file: String,
        /// Line of the names.
        line: Option<u64>,
        /// Its columns.
        found: String,
    },
    /// A constant speed needs a path.
    #[error(
        "--stage constant:SPEED needs the path of the clamp: give --path SCENE, a TOML file with [sweep], or a scene as --rod"
    )]
    NoPath,
    /// The pose of the clamp is not known.
    #[error("{address}: the poses of the clamp are missing; give --stage constant:SPEED or table:FILE")]
    NoStage {
        /// Where the samples come from.
        address: String,
    },
    /// The motion of the stage is not possible.
    #[error("the stage: {0}")]
    Stage(StageError),
    /// A table cannot be read, or lacks columns.
    #[error(transparent)]
    Table(TableError),
    /// A row of the table of poses cannot be used.
    #[error("{}:{line}: {problem}", file.display())]
    StageRow {
        /// Which file.
        file: PathBuf,
        /// Which line.
        line: u64,
        /// What is wrong with it.
        problem: RowProblem,
    },
    /// A table of poses is not possible.
    #[error("{}: {source}", file.display())]
    StageTable {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: StageError,
    },
    /// The sensor cannot be tared.
    #[error(
        "no tare from the first {seconds} s: {source}; start where the rod is free, or change [tare] of the setup (seconds = 0 for none)"
    )]
    Tare {
        /// How long the window is, s.
        seconds: f64,
        /// Why.
        source: TareError,
    },
    /// Too few samples before the end.
    #[error(
        "{samples} samples before the end, expected at least {fewest} for the tare and the noise of the sensor{first}"
    )]
    TooFew {
        /// Their number.
        samples: usize,
        /// The smallest number.
        fewest: usize,
        /// The first fault, if there was one.
        first: String,
    },
    /// The recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The settings of the reconstruction are not possible.
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
    /// The files.
    #[error(transparent)]
    Output(#[from] OutputError),
}
