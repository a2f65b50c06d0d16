//! Why a file is no table.

use super::options::Delimiter;

/// Why a file is no table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The file cannot be read.
    #[error("cannot read {file}: {source}")]
    Unreadable {
        /// Which file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// The file is longer than allowed.
    #[error("{file}: longer than {most} bytes, expected no more; cut it, or allow more in the options")]
    TooLong {
        /// Which file.
        file: String,
        /// What is allowed.
        most: u64,
    },
    /// There is nothing in it.
    #[error("{file}: no line that names columns, expected one, and rows of numbers below it")]
    Empty {
        /// Which file.
        file: String,
    },
    /// The first line of the table holds numbers.
    #[error(
        "{file}:{line}: the first line holds numbers, expected the names of the columns above them; add such a line, or give the names in the options"
    )]
    NoHeader {
        /// Which file.
        file: String,
        /// Its first line of numbers.
        line: u64,
    },
    /// The line asked for is not there.
    #[error(
        "{file}: no line {line} with names of columns, expected one as the options say; the file has {lines} lines"
    )]
    NoSuchLine {
        /// Which file.
        file: String,
        /// The line asked for.
        line: u64,
        /// How many there are.
        lines: u64,
    },
    /// The names do not fit the rows.
    #[error(
        "{file}:{line}: {names} names, but {cells} cells in most rows ({delimiter} between them), expected as many; {}",
        Missing(*line, hint.as_deref())
    )]
    HeaderWidth {
        /// Which file.
        file: String,
        /// Line of the names, or of the first row where the names are given.
        line: u64,
        /// How many names.
        names: usize,
        /// How many cells most rows have.
        cells: usize,
        /// What is between them.
        delimiter: Delimiter,
        /// A heading that may be two.
        hint: Option<String>,
    },
    /// Commas between numbers or in them.
    #[error(
        "{file}:{line}: `{text}` could be numbers with decimal commas or numbers separated by commas ({cells} of them, under {names} names); say which in the options: either the decimal mark (and the delimiter), or delimiter comma and the names of all columns"
    )]
    AmbiguousComma {
        /// Which file.
        file: String,
        /// A line that shows it.
        line: u64,
        /// Its beginning.
        text: String,
        /// How many names there are.
        names: usize,
        /// How many cells, if commas separate them.
        cells: usize,
    },
    /// Both decimal marks.
    #[error(
        "{file}: `{point}` in line {point_line} has a decimal point, `{comma}` in line {comma_line} a decimal comma, expected the same in all columns; say which in the options"
    )]
    MixedDecimals {
        /// Which file.
        file: String,
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
    #[error("{file}:{line}: more than {most} columns, expected no more; is this a table?")]
    TooManyColumns {
        /// Which file.
        file: String,
        /// Which line.
        line: u64,
        /// How many there may be.
        most: usize,
    },
    /// A unit for a column that is not there.
    #[error("{file}: no column `{column}`, for which the options give a unit; found {found}")]
    NoSuchColumn {
        /// Which file.
        file: String,
        /// The name.
        column: String,
        /// All there are.
        found: String,
    },
    /// Something is wrong with the headers of an LVM file.
    #[error("{file}:{line}: {what}, expected {expected}")]
    Lvm {
        /// Which file.
        file: String,
        /// Which line.
        line: u64,
        /// What.
        what: String,
        /// What is expected there.
        expected: &'static str,
    },
    /// Several tables in one file.
    #[error("{file}: {segments} segments, expected one; say which in the options, or read all")]
    Segments {
        /// Which file.
        file: String,
        /// How many.
        segments: usize,
    },
}

/// What to do about names that do not fit.
struct Missing<'e>(u64, Option<&'e str>);

impl std::fmt::Display for Missing<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.1 {
            Some(hint) => {
                write!(f, "a delimiter is missing in `{hint}`; mend line {}, or give the names in the options", self.0)
            }
            None => write!(f, "mend line {}, or give the names or the delimiter in the options", self.0),
        }
    }
}
