//! Recordings: what a clamp felt along its way, read from a table of text or from what a sensor sent.
//!
//! The library reads the table. `columns` finds the columns by name, `row` reads one row, `read` puts them together. `error` says what is wrong with files and single rows. A row that
//! cannot be used keeps its `place`.

mod columns;
mod error;
mod read;
mod row;

pub use error::RecordingError;
pub use row::{Place, RowFault, RowProblem};

use std::path::PathBuf;
use vibrissa::Sample;
use vibrissa::hw::recording::{ColumnMap, TableOptions};
use vibrissa::rod::PhysicalRod;

/// A row of a recording: a sample, or what is wrong with it.
pub type Row = Result<Sample, RowFault>;

/// What a clamp felt along its way, SI units.
///
/// The file is a table of text (CSV, TSV, LVM: [`Table`](vibrissa::hw::recording::Table)) with the columns x0, y0 (m), phi0 (rad),
/// f0x, f0y (N), m0z (N m) in any order, perhaps t (s), and perhaps all of sigma_f0x, sigma_f0y (N), sigma_m0z (N m), the
/// standard deviations; or in other units that are written in the names, as `f0x [mN]`. Rows that a column quality calls
/// saturated, wrong or a spike cannot be used.
///
/// The clamp must go on: a row with the pose of the last usable one, or one that turns back, cannot be used. Distances
/// of poses are those of (x, y, L phi), and no movement is one of less than 1e-12 L. The direction is that of the last
/// rows; a pose farther away than twice the whole way before it starts a new direction, so that a clamp that trembled
/// before it set off costs its trembling only.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Where it was read from.
    pub file: PathBuf,
    /// All rows in order.
    pub rows: Vec<Row>,
    /// Names of the columns that are not looked at.
    pub ignored: Vec<String>,
    /// Places of usable rows whose time is not later than that of the usable row before.
    pub late: Vec<Place>,
    /// Whether the end is missing, as far as that can be told.
    pub cut: bool,
    /// What the file says where it ends early, as `vibrissa simulate` does when it is interrupted.
    pub incomplete: Option<String>,
    /// What else was noticed, in words.
    pub notes: Vec<String>,
}

/// How to read a recording, where the file alone does not determine it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// How the table is written.
    pub options: TableOptions,
    /// Which column means what.
    pub columns: ColumnMap,
    /// The same of the table of a stage, where it differs.
    pub stage: Option<Box<ReadOptions>>,
}

impl ReadOptions {
    /// How to read the table of a stage.
    pub fn of_stage(&self) -> &Self {
        self.stage.as_deref().unwrap_or(self)
    }
}

impl Recording {
    /// The recording with the poses of the base of a rod in place of those of the support of its clamp: where the springs go under the
    /// reactions of each sample.
    #[must_use]
    pub fn at_base(mut self, rod: &impl PhysicalRod) -> Self {
        for sample in self.rows.iter_mut().flatten() {
            sample.pose = rod.base(sample.pose, &sample.reactions);
        }
        self
    }

    /// The usable samples in order.
    pub fn samples(&self) -> impl Iterator<Item = &Sample> {
        self.rows.iter().flatten()
    }

    /// What is wrong with the other rows, in order.
    pub fn faults(&self) -> impl Iterator<Item = &RowFault> {
        self.rows.iter().filter_map(|row| row.as_ref().err())
    }
}
