//! The command line.

use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// A thin elastic rod swept along an object: contact phases, transitions and clamp reactions.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Exit status: 0 done, 1 an error, 2 a sweep that stopped early or does not give the paper's phases."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

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
    /// Run the nine scans of Merker et al. (2021) and compare their phases with the paper's
    Paper {
        /// Directory of the results
        #[arg(long, value_name = "DIR", default_value = "out")]
        out: PathBuf,
    },
}
