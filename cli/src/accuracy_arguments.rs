//! Options of the commands about accuracy: `calibrate` and `budget`.

use crate::arguments::Written;
use crate::values::seed;
use clap::Args;
use std::path::PathBuf;
use vibrissa_cli::Freed;

/// What recordings tell of rod, sensor, clamp and stage.
#[derive(Debug, Args)]
pub struct Calibrate {
    /// The recordings, as for `reconstruct`: of one rod, clamped once, with one sensor
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// The rod, a TOML file with the table [rod] of a scene, perhaps with an earlier calibration; or a scene
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    /// How large the errors may be that all samples share, the table [errors] of a TOML file [default: an ordinary laboratory]
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// The noise of the sensor, a TOML file as for `simulate` [default: found in the recordings]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// The errors to look for, with commas between them [default: all that have a budget]
    #[arg(long, value_name = "ERRORS", value_enum, value_delimiter = ',')]
    pub free: Vec<Freed>,
    /// The TOML file of the calibrated rod; calibration.svg is written beside it
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    #[command(flatten)]
    pub written: Written,
}
