#![doc = include_str!("../README.md")]
//!
//! What the command `vibrissa` does beyond the files of `rod-files`, without the printing: figures, the files of results with them,
//! calibration of a rod, the accuracy to expect, a sensor that is played, and the nine scans of the paper.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod budget;
mod calibrate;
mod fake_sensor;
mod figure;
mod init;
mod inspect_text;
mod merged;
mod paper;
mod results;
#[cfg(test)]
#[path = "../../files/src/sample.rs"]
mod sample;
mod shapes;

pub use budget::{BudgetError, BudgetStudy, ComparedRods, Expected, RodComparison};
pub use calibrate::{CalibrateError, Freed, RodCalibration};
pub use fake_sensor::{FakeError, FakeProtocol, FakeScan, Played};
pub use figure::FigureError;
pub use init::FirstScene;
pub use inspect_text::inspection_text;
pub use merged::Merged;
pub use paper::{Paper, PaperError, PaperScan};
pub use results::{
    WriteError, write_approaches, write_elastica, write_film, write_plan, write_profiles, write_reach,
    write_reconstruction, write_sweep,
};
pub use shapes::shapes_list;
