#![doc = include_str!("../README.md")]
//!
//! `toml_file` reads TOML with errors that name the place. `scene`, `setup`, `noise_file` and `study` are such files; `recording` is a table of
//! samples, `film` one of points on the rod and the forces from them, and `live` reads a sensor or a raw recording of one. `elastica` is a rod without contacts, `whisker` average whiskers, `scan` sweeps a scene, `simulation` records it, `reconstructed` turns a
//! recording back. `output` writes files that appear when they are complete.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod clamp_columns;
mod cycle;
mod elastica;
mod film;
mod inspect;
mod interrupt;
mod interval;
mod live;
mod noise_file;
pub mod output;
mod planned;
mod profile;
mod reached;
mod reconstructed;
mod recording;
mod report;
#[cfg(test)]
mod sample;
mod scan;
mod scene;
mod setup;
mod simulation;
mod study;
pub mod table;
mod toml_file;
mod whisker;

pub use cycle::{CYCLES, Cycle};
pub use elastica::ElasticaRun;
pub use film::{AtRestError, Ends, FilmError, FilmForces, FilmOptions, channels_of_columns};
pub use inspect::{
    Certainty, Fact, InspectFault, InspectOptions, InspectedColumn, InspectedFile, Inspection, Question, ReadCommand,
    RodInspected, inspect, quoted,
};
pub use interrupt::{Interrupt, Interrupted};
pub use interval::{Interval, intervals};
pub use live::{
    AddressError, End, Fed, Feed, Latency, LiveError, LiveReport, LiveScan, Miss, Sensor, SensorAddress, StageDelay,
    StageDelayError, StageSpec, StageSpecError,
};
pub use noise_file::read_noise;
pub use output::{OutputError, Staged};
pub use planned::{Approaches, LargestStress, PlanFileError, PlanRequest, Planned, PlannedScan, read_known_contours};
pub use profile::{Profile, ProfileError, ProfilePoint, write_profile_table};
pub use reached::{OutlinePart, Reached, Touch};
pub use reconstructed::{
    CONTOUR_COLUMNS, Comparison, FittedPoint, Reconstructed, ReconstructionError, Together, Transition, TruthError,
    confounders_text, naive_touch,
};
pub use recording::{Place, ReadOptions, Recording, RecordingError, Row, RowFault, RowProblem};
pub use scan::Scan;
pub use scene::{
    CalibratedRod, ElasticaScene, FilmedRod, Leg, LegPath, RodOnPath, ScanList, Scene, SceneFriction,
    read_calibrated_rod, read_filmed_rod, read_scans, read_uniform_rod, unit_of,
};
pub use setup::{Gauges, RecordingSetup, RecordingTime, SensorCalibration, Setup, TareSetup};
pub use simulation::{Simulated, Simulation, SimulationArgument, SimulationError, Speed, Tick, Ticks};
pub use study::{Measured, Study, StudyError, StudyRow, StudyRun};
pub use toml_file::{Invalid, SceneError};
pub use whisker::{Animal, Whisker, WhiskerError, WhiskerSources, mean_curvature};
