//! Faults of single rows.

use std::fmt;

/// A row that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct RowFault {
    /// Its line in the file, from 1.
    pub line: u64,
    /// The fault.
    pub problem: RowProblem,
}

impl fmt::Display for RowFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.problem)
    }
}

impl std::error::Error for RowFault {}

/// A fault of a row.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RowProblem {
    /// Too few cells, or too many.
    #[error("the number of cells is {found}, expected {expected}{}", if *.cut { "; the file was cut there" } else { "" })]
    Cells {
        /// How many there are.
        found: usize,
        /// How many columns there are.
        expected: usize,
        /// Whether it is the last line and has no end.
        cut: bool,
    },
    /// Nothing where a number should be.
    #[error("{column} is empty, expected a number")]
    Missing {
        /// Name of its column.
        column: String,
    },
    /// A cell that is no number.
    #[error("{column} is `{text}`, expected a number")]
    NoNumber {
        /// Name of its column.
        column: String,
        /// The text, shortened if it is long.
        text: String,
    },
    /// A number that is not finite.
    #[error("{column} is {value}, expected a finite number")]
    NotFinite {
        /// Name of its column.
        column: String,
        /// Its value.
        value: f64,
    },
    /// A negative standard deviation or bound.
    #[error("{column} is {value}, expected a number that is not negative")]
    Negative {
        /// Name of its column.
        column: String,
        /// Its value.
        value: f64,
    },
    /// A text that is not a number or status word.
    #[error("{column} is {value}, expected a whole number from 0 to {most}")]
    NoCount {
        /// Name of its column.
        column: String,
        /// Its value.
        value: f64,
        /// The largest there may be.
        most: f64,
    },
    /// A flag that is not known.
    #[error("{column} is `{text}`, expected good, or flags by their names, with | between them")]
    NoFlag {
        /// Name of its column.
        column: String,
        /// The text, shortened if it is long.
        text: String,
    },
    /// The clock began anew: this row and all after it have other times.
    #[error(
        "the clock began anew in line {line}, at {t} s after {before} s, expected one clock in a file: save the rows from line {line} on in another"
    )]
    Restarted {
        /// Line of the first such row.
        line: u64,
        /// Its time, s.
        t: f64,
        /// The time before, s.
        before: f64,
    },
    /// The time does not grow.
    #[error("the time {t} s is not later than {before} s of line {of}, expected a later time")]
    Late {
        /// The time, s.
        t: f64,
        /// The time before, s.
        before: f64,
        /// Line of the row with that.
        of: u64,
    },
}

/// Most characters of a cell that are shown.
const MOST_SHOWN: usize = 24;

pub(super) fn shown(text: &str) -> String {
    text.chars().take(MOST_SHOWN).collect()
}

impl RowProblem {
    pub(super) fn no_number(column: String, text: &str) -> Self {
        Self::NoNumber { column, text: shown(text) }
    }
}
