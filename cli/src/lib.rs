#![doc = include_str!("../README.md")]
//!
//! What the command `vibrissa` does, without the printing: scene files, the files and figures of a sweep and of
//! contours, recordings and what they tell, the nine scans of the paper and the reports on them.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod budget;
mod calibrate;
mod cycle;
mod fake_sensor;
mod figure;
mod init;
mod interrupt;
mod interval;
mod live;
mod merged;
mod noise_file;
mod output;
mod paper;
mod profile;
mod reconstructed;
mod recording;
mod report;
#[cfg(test)]
mod sample;
mod scan;
mod scene;
mod setup;
mod shapes;
mod simulation;
mod study;
mod table;
mod toml_file;

pub use budget::{BudgetError, BudgetStudy, Expected};
pub use calibrate::{CalibrateError, Freed, RodCalibration};
pub use cycle::Cycle;
pub use fake_sensor::{FakeError, FakeProtocol, FakeScan, Played};
pub use figure::FigureError;
pub use init::{FIRST_SCENE, write_first_scene};
pub use interrupt::{Interrupt, Interrupted};
pub use interval::Interval;
pub use live::{
    AddressError, End, Fed, Feed, Latency, LiveError, LiveReport, LiveScan, Miss, Sensor, SensorAddress, StageSpec,
    StageSpecError,
};
pub use merged::Merged;
pub use noise_file::read_noise;
pub use output::{OutputError, Staged, WriteError, abandon, check_output, write_profile_table, write_profiles};
pub use paper::{Paper, PaperError, PaperScan};
pub use profile::{Profile, ProfileError, ProfilePoint};
pub(crate) use reconstructed::naive_touch;
pub use reconstructed::{Comparison, Reconstructed, ReconstructionError, Transition, TruthError};
pub use recording::{Place, ReadOptions, Recording, RecordingError, Row, RowFault, RowProblem};
pub use scan::Scan;
pub use scene::{CalibratedRod, Leg, LegPath, Scene, SceneFriction, read_calibrated_rod, read_rod, read_uniform_rod};
pub use setup::{Gauges, RecordingSetup, RecordingTime, SensorCalibration, Setup, TareSetup};
pub use shapes::shapes_list;
pub use simulation::{Simulated, Simulation, SimulationError, Tick, Ticks};
pub use study::{Measured, Study, StudyError, StudyRow, StudyRun};
pub use toml_file::{Invalid, SceneError};
