//! Why a file is no recording, and what is wrong with single rows.

use super::columns::EXPECTED;
use super::{Place, Recording, RowFault, RowProblem};
use std::mem::{Discriminant, discriminant};
use std::path::PathBuf;
use vibrissa::hw::recording::{RowProblem as CellProblem, TableError};

/// Most lines that are named for each kind of fault.
const MOST_LINES: usize = 5;

impl Recording {
    /// A line for each kind of fault, with the file, the first lines where it is, and how many there are; for a time
    /// that does not grow; for columns that are not looked at; and for an end that is missing.
    pub fn warnings(&self) -> Vec<String> {
        let file = self.file.display();
        let mut warnings = Vec::new();
        if !self.ignored.is_empty() {
            warnings.push(format!("{file}: columns not used: {}", self.ignored.join(", ")));
        }
        let mut kinds: Vec<(Kind, Vec<&RowFault>)> = Vec::new();
        for fault in self.faults() {
            let kind = kind_of(&fault.problem);
            match kinds.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, faults)) => faults.push(fault),
                None => kinds.push((kind, vec![fault])),
            }
        }
        for (_, faults) in kinds {
            let places: Vec<Place> = faults.iter().map(|fault| fault.place).collect();
            let (count, rows) = (faults.len(), self.rows.len());
            warnings.push(format!(
                "{file}: {count} of {rows} rows cannot be used, {}: {}",
                Place::several(&places, MOST_LINES),
                faults[0].problem
            ));
        }
        if !self.late.is_empty() {
            let (count, rows) = (self.late.len(), self.rows.len());
            let at = Place::several(&self.late, MOST_LINES);
            warnings.push(format!("{file}: the time does not increase in {count} of {rows} rows, {at}"));
        }
        if self.cut {
            warnings.push(format!("{file}: the end of the recording is missing"));
        }
        if let Some(why) = &self.incomplete {
            warnings.push(format!("{file}: the recording is incomplete: {why}"));
        }
        warnings.extend(self.notes.iter().map(|note| format!("{file}: {note}")));
        warnings
    }
}

/// What kind of problem, also among those of cells.
pub(super) type Kind = (Discriminant<RowProblem>, Option<Discriminant<CellProblem>>);

pub(super) fn kind_of(problem: &RowProblem) -> Kind {
    let of_cell = if let RowProblem::Cell(problem) = problem { Some(discriminant(problem)) } else { None };
    (discriminant(problem), of_cell)
}

/// Why a file is no recording.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file cannot be read.
    #[error("cannot read the recording {}: {source}", file.display())]
    Unreadable {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// There is nothing in it.
    #[error("{}: no line that names columns, expected {EXPECTED}", file.display())]
    Empty {
        /// Which file.
        file: PathBuf,
    },
    /// Columns are missing.
    #[error("{}:{line}: no column {}, found {found}; expected {EXPECTED}{hint}", file.display(), missing.join(", "))]
    Missing {
        /// Which file.
        file: PathBuf,
        /// Line of the names.
        line: u64,
        /// Which columns.
        missing: Vec<String>,
        /// All columns there are.
        found: String,
        /// What may have been meant, or nothing.
        hint: String,
    },
    /// It is no table, or its columns are ambiguous or without a unit.
    #[error(transparent)]
    Table(TableError),
    /// A stage is given for a table that has poses.
    #[error("{}: its rows have poses of the clamp, expected no --stage", file.display())]
    Posed {
        /// Which file.
        file: PathBuf,
    },
    /// There is the reaction of a roller ahead of the clamp, which the others do not tell without.
    #[error(
        "{}: the column roller is the reaction of a roller ahead of the clamp, expected a recording without one; \
         `vibrissa::reconstruct::through_roller` takes single samples",
        file.display()
    )]
    Roller {
        /// Which file.
        file: PathBuf,
    },
    /// Most rows cannot be used.
    #[error(
        "{}: {} of {rows} rows cannot be used, expected at most half of them; {}",
        file.display(),
        faults.len(),
        firsts(faults)
    )]
    Unusable {
        /// Which file.
        file: PathBuf,
        /// How many rows there are.
        rows: usize,
        /// What is wrong with those that cannot be used.
        faults: Vec<RowFault>,
    },
    /// Too little is left.
    #[error("{}: {usable} usable rows, expected at least {expected}", file.display())]
    TooFew {
        /// Which file.
        file: PathBuf,
        /// How many there are.
        usable: usize,
        /// How many there must be.
        expected: usize,
    },
}

/// The first fault of each kind.
fn firsts(faults: &[RowFault]) -> String {
    let mut kinds = Vec::new();
    let mut texts = Vec::new();
    for fault in faults {
        let kind = super::error::kind_of(&fault.problem);
        if !kinds.contains(&kind) {
            kinds.push(kind);
            texts.push(fault.to_string());
        }
    }
    texts.join("; ")
}
