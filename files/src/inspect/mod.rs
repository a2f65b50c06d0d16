//! A look at files of unknown layout: what they hold, what must be mended, and the command that reads them.
//!
//! `look` describes one file: `layout` how it is written, `rows` its times and cells, `motion` the path of the clamp, `binary` files of
//! other programs. `physics` finds axes, signs and units (`frame`, `energy`). `commands` puts files together and tries the readers with
//! the options of `proposal` and the `setup_text`.

mod binary;
mod commands;
mod energy;
mod frame;
mod layout;
mod look;
mod motion;
mod physics;
mod proposal;
mod report;
mod rows;
mod setup_text;
mod values;

pub use report::{Certainty, Fact, InspectFault, InspectedColumn, InspectedFile, Inspection, Question, ReadCommand};

use crate::{ReadOptions, Setup};
use look::Look;
use std::path::PathBuf;
use vibrissa::Rod;

/// A rod and its file.
#[derive(Clone, Debug)]
pub struct RodInspected {
    /// The file.
    pub file: PathBuf,
    /// The rod, as it is at its clamp.
    pub rod: Rod,
}

/// What is known before a look.
#[derive(Clone, Debug, Default)]
pub struct InspectOptions {
    /// The rod of the recordings.
    pub rod: Option<RodInspected>,
    /// What the user said of layout, columns and units.
    pub read: ReadOptions,
    /// A setup, with its file.
    pub setup: Option<(PathBuf, Setup)>,
    /// Where a setup is to be written.
    pub write_setup: Option<PathBuf>,
}

/// A word of a command line as a shell takes it: in quotes where it needs them.
pub fn quoted(word: &str) -> String {
    look::quoted(word)
}

/// Looks at files.
pub fn inspect(files: &[PathBuf], options: &InspectOptions) -> Inspection {
    let mut looks: Vec<Look> = files.iter().map(|file| Look::at(file, &options.read)).collect();
    let commands = commands::commands(&mut looks, options);
    Inspection { files: looks.into_iter().map(|look| look.report).collect(), commands }
}
