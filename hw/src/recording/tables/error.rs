//! Why a file is no table, or a table without the columns that are needed.

use super::options::Delimiter;
use super::role::{Role, si};
use crate::sample::{Channels, Dimension, UnitError};
use std::fmt;

/// Why a file is no table, or a table without the columns that are needed. Displays as `file:line: problem`.
#[derive(Debug)]
pub struct TableError {
    /// The file.
    pub file: String,
    /// Its line, from 1, where one is to blame: mostly that of the names.
    pub line: Option<u64>,
    /// The fault.
    pub problem: TableProblem,
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, problem } = self;
        match (problem, line) {
            (TableProblem::Unreadable(source), _) => write!(f, "cannot read {file}: {source}"),
            (_, Some(line)) => write!(f, "{file}:{line}: {problem}"),
            (_, None) => write!(f, "{file}: {problem}"),
        }
    }
}

impl std::error::Error for TableError {}

/// A fault of a table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableProblem {
    /// The file cannot be read.
    #[error("{0}")]
    Unreadable(std::io::Error),
    /// The file is longer than allowed.
    #[error("longer than {most} bytes, expected no more; cut it, or allow more in the options")]
    TooLong {
        /// The limit.
        most: u64,
    },
    /// There is nothing in it.
    #[error("no line that names columns, expected one, and rows of numbers below it")]
    Empty,
    /// The first line of the table holds numbers.
    #[error(
        "the first line holds numbers, expected the names of the columns above them; add such a line, or give the names in the options"
    )]
    NoHeader,
    /// The requested line does not exist.
    #[error("no line {line} with names of columns, expected one as the options say; the file has {lines} lines")]
    NoSuchLine {
        /// The requested line.
        line: u64,
        /// How many there are.
        lines: u64,
    },
    /// The names do not fit the rows.
    #[error("{names} names, but {cells} cells in most rows ({delimiter} between them), expected as many; {remedy}")]
    HeaderWidth {
        /// How many names.
        names: usize,
        /// How many cells most rows have.
        cells: usize,
        /// The separator.
        delimiter: Delimiter,
        /// The remedy.
        remedy: String,
    },
    /// Commas between numbers or in them.
    #[error(
        "`{text}` could be numbers with decimal commas or numbers separated by commas ({cells} of them, under {names} names); say which in the options: either `decimal` (and `delimiter`), or `delimiter` comma and the names of all columns"
    )]
    AmbiguousComma {
        /// The beginning of a line that shows it.
        text: String,
        /// How many names there are.
        names: usize,
        /// How many cells, if commas separate them.
        cells: usize,
    },
    /// Both decimal marks.
    #[error(
        "`{point}` in line {point_line} has a decimal point, `{comma}` in line {comma_line} a decimal comma, expected the same in all columns; say which in the option `decimal`"
    )]
    MixedDecimals {
        /// A cell with a point.
        point: String,
        /// Its line.
        point_line: u64,
        /// A cell with a comma.
        comma: String,
        /// Its line.
        comma_line: u64,
    },
    /// More columns than any sensor has.
    #[error("more than {most} columns, expected no more; is this a table?")]
    TooManyColumns {
        /// How many there may be.
        most: usize,
    },
    /// Something is wrong with the headers of an LVM file.
    #[error("{what}, expected {expected}")]
    Lvm {
        /// The fault.
        what: String,
        /// The expected text.
        expected: &'static str,
    },
    /// Several tables in one file.
    #[error("{segments} segments, expected one; say which in the option `segment`, or read all")]
    Segments {
        /// How many.
        segments: usize,
    },
    /// A workbook that cannot be opened.
    #[error(
        "the workbook cannot be read: {what}; expected a sheet of names and numbers (.xlsx), or save the sheet as CSV"
    )]
    Workbook {
        /// The reason.
        what: String,
    },
    /// Several sheets with a table.
    #[error("{} sheets have tables ({}), expected one; say which in the option `segment`, from 1", names.len(), listed(names.iter().map(String::as_str)))]
    Sheets {
        /// Their names.
        names: Vec<String>,
    },
    /// Bytes that no text has.
    #[error("a byte of zero, which no text has, expected a table (CSV, TSV or LVM)")]
    Binary,
    /// A segment of a table that has none.
    #[error("the option `segment` is {segment}, but only LVM files have segments; leave it out")]
    NoSegments {
        /// The requested part number.
        segment: usize,
    },
    /// A unit for a column that is not there.
    #[error("no column `{column}`, for which the option `unit` gives one; found {found}")]
    NoColumnOfUnit {
        /// The name.
        column: String,
        /// All columns there are.
        found: String,
    },
    /// There are no columns for these.
    #[error("no column {}, found {found}{hint}", listed(missing.iter().map(|role| role.name())))]
    Missing {
        /// For what.
        missing: Vec<Role>,
        /// All columns there are.
        found: String,
        /// A suggestion, or nothing.
        hint: String,
    },
    /// No column of a name that was said.
    #[error("no column `{name}`, found {found}")]
    NoSuchColumn {
        /// The name.
        name: String,
        /// All columns there are.
        found: String,
    },
    /// Two columns for the same.
    #[error(
        "two columns are named {name}{}, expected one; say which in the option `column`, or rename one",
        Other(name, other)
    )]
    Twice {
        /// Name of the first.
        name: String,
        /// Name of the second.
        other: String,
    },
    /// An unknown unit, or one of another dimension.
    #[error("the unit of {column}: {source}")]
    Unit {
        /// Which column.
        column: String,
        /// The fault.
        source: Box<UnitError>,
    },
    /// No unit.
    #[error("no unit of {column}, expected one of {dimension}, as in `{column} [{}]`; write it there, or give it in the options; only a column named {role} needs no unit, it is in {}", si(*.dimension), si(*.dimension))]
    NoUnit {
        /// Which column.
        column: String,
        /// Its meaning.
        role: Role,
        /// Its physical dimension.
        dimension: Dimension,
    },
    /// No raw values.
    #[error("no channels, found {found}; name them in the column map, expected 1 to {} columns", Channels::MOST)]
    NoChannels {
        /// All columns there are.
        found: String,
    },
    /// More raw values than a sample holds.
    #[error("{count} channels, expected at most {}; name those that are needed in the column map", Channels::MOST)]
    TooManyChannels {
        /// How many.
        count: usize,
    },
    /// Channels with times of their own that differ.
    #[error(
        "`{column}` is {value}, `{first}` {expected}, expected the same times for all channels; read them one by one, or resample"
    )]
    OtherTimes {
        /// A column of times.
        column: String,
        /// The time there.
        value: f64,
        /// The first column of times.
        first: String,
        /// The time there.
        expected: f64,
    },
}

impl TableProblem {
    /// In this file, at this line of it.
    pub(super) fn at(self, file: &str, line: impl Into<Option<u64>>) -> TableError {
        TableError { file: file.to_owned(), line: line.into(), problem: self }
    }
}

struct Other<'e>(&'e str, &'e str);

impl fmt::Display for Other<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == self.1 { Ok(()) } else { write!(f, " and {}, which mean the same", self.1) }
    }
}

/// Most columns that are named in a message.
const MOST_NAMES: usize = 20;

pub(super) fn listed<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    let more = if names.len() > MOST_NAMES { format!(" and {} more", names.len() - MOST_NAMES) } else { String::new() };
    names[..names.len().min(MOST_NAMES)].join(", ") + &more
}
