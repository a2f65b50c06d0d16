//! Why a file is no recording.

use super::RowFault;
use super::columns::EXPECTED;
use std::path::PathBuf;
use vibrissa::hw::recording::TableError;

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
        let kind = super::warnings::kind_of(&fault.problem);
        if !kinds.contains(&kind) {
            kinds.push(kind);
            texts.push(fault.to_string());
        }
    }
    texts.join("; ")
}
