//! Why a file is no recording.

use super::RowFault;
use super::columns::EXPECTED;
use std::fmt::Write;
use std::path::PathBuf;

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
    #[error("{}:{line}: no column {}, found {}; expected {EXPECTED}{hint}", file.display(), listed(missing), listed(found))]
    Missing {
        /// Which file.
        file: PathBuf,
        /// Line of the names.
        line: u64,
        /// Which columns.
        missing: Vec<String>,
        /// All columns there are.
        found: Vec<String>,
        /// What may have been meant, or nothing.
        hint: String,
    },
    /// Two columns of one name.
    #[error("{}:{line}: two columns are named {column}, expected one", file.display())]
    Twice {
        /// Which file.
        file: PathBuf,
        /// Line of the names.
        line: u64,
        /// Their name.
        column: &'static str,
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

/// Most columns that are named in a message.
const MOST_NAMES: usize = 20;

fn listed(names: &[String]) -> String {
    let mut text = names.iter().take(MOST_NAMES).map(String::as_str).collect::<Vec<_>>().join(", ");
    if names.len() > MOST_NAMES {
        let _ = write!(text, " and {} more", names.len() - MOST_NAMES);
    }
    text
}

/// The first fault of each kind.
fn firsts(faults: &[RowFault]) -> String {
    let mut kinds = Vec::new();
    let mut texts = Vec::new();
    for fault in faults {
        let kind = std::mem::discriminant(&fault.problem);
        if !kinds.contains(&kind) {
            kinds.push(kind);
            texts.push(fault.to_string());
        }
    }
    texts.join("; ")
}
