//! The command line.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// A thin elastic rod swept along an object: contact phases, transitions and clamp reactions.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Exit status: 0 done, 1 an error, 2 a sweep that stopped early or does not give the paper's phases, a recording that does not \
                  fit its rod or its units."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const RECONSTRUCT: &str = "\
Turn a recording of clamp reactions back into contact points, phases and the contour.

Writes points.jsonl (one object for each row of the recording, in order: clamp pose, contact point, label, and null with a
reason where there is no answer), contour.csv (stretches of the contour; gaps stay gaps) and report.json (rows, noise,
labels, kinks, gaps, a check by the physics and, with --truth, errors), SI units throughout.";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Sweep the rod of a scene file: states.jsonl, states.csv, events.jsonl and sweep.svg
    Sweep {
        /// The scene, a TOML file
        scene: PathBuf,
        /// Directory of the results [default: out/<name of the scene>]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Write the contours of a scene as points (CSV), and a drawing of them beside it (SVG)
    Contour {
        /// The scene, a TOML file
        scene: PathBuf,
        /// The CSV file; the drawing has the same name with .svg [default: out/<name of the scene>/contour.csv]
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Largest distance of a chord between two points from the contour, m [default: 1e-6 of the rod's length]
        #[arg(long, value_name = "METRES")]
        tolerance: Option<f64>,
        /// Only this object, from 1
        #[arg(long, value_name = "N")]
        object: Option<usize>,
    },
    /// Write what a sensor at the clamp would record along a scene (CSV, SI units: t,x0,y0,phi0,f0x,f0y,m0z)
    Simulate(Simulate),
    /// Turn a recording of clamp reactions back into contact points, phases and the contour
    #[command(long_about = RECONSTRUCT)]
    Reconstruct {
        /// The recording: CSV with the columns x0,y0 (m), phi0 (rad), f0x,f0y (N), m0z (N m), perhaps t (s) and the
        /// standard deviations sigma_f0x,sigma_f0y,sigma_m0z
        recording: PathBuf,
        /// The rod, a TOML file with the table [rod] of a scene; or a scene
        #[arg(long, value_name = "FILE")]
        rod: PathBuf,
        /// The scene that the recording is of, to compare with
        #[arg(long, value_name = "SCENE")]
        truth: Option<PathBuf>,
        /// Directory of the results [default: out/<name of the recording>]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Run the nine scans of Merker et al. (2021) and compare their phases with the paper's
    Paper {
        /// Directory of the results
        #[arg(long, value_name = "DIR", default_value = "out")]
        out: PathBuf,
    },
}

/// A recording to be made.
#[derive(Debug, Args)]
pub struct Simulate {
    /// The scene, a TOML file; its step is not used
    pub scene: PathBuf,
    /// The noise of the sensor, a TOML file [default: a sensor that reads the truth]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Samples in a second; there is one every speed / rate of the clamp's way
    #[arg(long, value_name = "HZ", default_value_t = 500.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Speed of the clamp: m/s, or rad/s where the clamp only turns
    #[arg(long, value_name = "SPEED", default_value_t = 1e-3, allow_negative_numbers = true)]
    pub speed: f64,
    /// Seed of the noise: the same one gives the same recording
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Write the standard deviations of white and AR(1) noise and the quantum, too: sigma_f0x,sigma_f0y,sigma_m0z
    #[arg(long)]
    pub sigmas: bool,
    /// The CSV file [default: out/<name of the scene>/recording.csv]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
