//! Options of the commands about accuracy: `calibrate` and `budget`.

use crate::recording_arguments::{Moved, Written};
use crate::values::{directory, friction, positive, seed};
use clap::Args;
use rod_files::Speed;
use std::path::PathBuf;
use vibrissa::reconstruct::Friction;
use vibrissa_cli::Freed;

/// Most recordings with random errors: hours of work.
const MOST_RUNS: usize = 100_000;

/// Calibration of rod, sensor, clamp and stage from recordings.
#[derive(Debug, Args)]
pub struct Calibrate {
    /// The recordings, as for `reconstruct`: of one rod, clamped once, with one sensor
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// The rod, a TOML file with the table [rod] of a scene, perhaps with an earlier calibration; or a scene
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    /// Size of the systematic errors, the table [errors] of a TOML file [default: an ordinary laboratory]; for raw values and wrenches
    /// also calibration, mounting and tare, as for `live`
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// The noise of the sensor, a TOML file as for `simulate` [default: found in the recordings]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// The errors to look for, with commas between them [default: all that have a budget]
    #[arg(long, value_name = "ERRORS", value_enum, value_delimiter = ',')]
    pub free: Vec<Freed>,
    /// Coulomb friction of rod and objects, as for `reconstruct`. Each recording has a coefficient of its own, which takes part in the estimate;
    /// passes there and back have the same
    #[arg(long, value_name = "MU", allow_hyphen_values = true, value_parser = friction, default_value = "none")]
    pub friction: Friction,
    /// The TOML file of the calibrated rod; calibration.svg is written beside it
    #[arg(long, alias = "out", value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub moved: Moved,
    #[command(flatten)]
    pub written: Written,
}

/// What accuracy to expect of a scene.
#[derive(Debug, Args)]
pub struct Expect {
    /// The scene, a TOML file; its step is not used. With --rods a study, whose scenes differ in their rods
    pub scene: PathBuf,
    /// Compare the rods of a study: the table ranks its scenes by the standard deviation that the noise alone leaves, for rods of all kinds
    #[arg(long, requires = "noise", conflicts_with_all = ["setup", "friction", "runs", "seed"])]
    pub rods: bool,
    /// With --rods the standard deviation that is asked for, m
    #[arg(long, value_name = "M", default_value = "1e-4", requires = "rods", value_parser = positive)]
    pub sigma: f64,
    /// Size of the systematic errors, the table [errors] of a TOML file [default: an ordinary laboratory]
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// The noise of the sensor, a TOML file as for `simulate` [default: white, 0.008 E I / L^2 and 0.003 E I / L]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Coulomb friction that the reconstruction assumes, as for `reconstruct` [default: estimate, if the scene has friction]
    #[arg(long, value_name = "MU", allow_hyphen_values = true, value_parser = friction)]
    pub friction: Option<Friction>,
    /// Samples in a second
    #[arg(long, value_name = "HZ", default_value_t = 500.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Speed of the clamp: a number in m/s, or in rad/s where the clamp only turns, or with a unit as "1 mm/s" or "10 deg/s"
    #[arg(long, value_name = "SPEED", default_value = "1e-3", allow_negative_numbers = true)]
    pub speed: Speed,
    /// Number of recordings with random errors
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = runs)]
    pub runs: usize,
    /// Seed of errors and noise: the same one gives the same results
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = seed)]
    pub seed: u64,
    /// Directory of the results [default: out/<name of the scene>]
    #[arg(long, value_name = "DIR", value_parser = directory)]
    pub out: Option<PathBuf>,
}

fn runs(text: &str) -> Result<usize, String> {
    let runs = text.parse().ok().filter(|runs| *runs <= MOST_RUNS);
    runs.ok_or_else(|| format!("expected a whole number from 0 to {MOST_RUNS}"))
}
