//! How a table is written: given by the caller, or detected.

use std::fmt;

/// The separator of the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab.
    Tab,
    /// Any number of blanks and tabs.
    Blanks,
}

impl fmt::Display for Delimiter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Comma => "commas",
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
            Self::Blanks => "blanks",
        })
    }
}

/// The mark before the fraction of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// 0.5
    Point,
    /// 0,5
    Comma,
}

/// Where the names of the columns come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Header {
    /// The line before the first row of numbers.
    #[default]
    Find,
    /// This line of the file, from 1, also where it is marked as a comment.
    Line(u64),
    /// There are none: the columns are called 1, 2, ...
    None,
    /// From here, in place of those in the file.
    Names(Vec<String>),
}

/// How a table is written, where the file alone does not tell. The default is to find everything out.
///
/// ```
/// use rod_hw::recording::{Decimal, Table, TableOptions};
/// let text = b"Fx [N]\n0,5\n"; // a column with a decimal comma, or two without a name for the second?
/// assert!(Table::parse("f.csv", text, &TableOptions::default()).is_err());
/// let options = TableOptions { decimal: Some(Decimal::Comma), ..TableOptions::default() };
/// let table = Table::parse("f.csv", text, &options)?;
/// assert_eq!(table.rows().nth(0).and_then(|row| row.number(0).ok()), Some(0.5));
/// # Ok::<(), rod_hw::recording::TableError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TableOptions {
    /// The separator of cells.
    pub delimiter: Option<Delimiter>,
    /// The decimal mark.
    pub decimal: Option<Decimal>,
    /// The names of the columns.
    pub header: Header,
    /// Names of columns and their units, which go before those in the file.
    pub units: Vec<(String, String)>,
    /// Which of several segments of an LVM file, from 1.
    pub segment: Option<usize>,
    /// Files longer than this are refused, bytes. A table takes at most 100 times as much memory as its file, where rows are as
    /// short as can be, and less than 4 times where numbers have 15 digits.
    pub most_bytes: u64,
}

impl Default for TableOptions {
    /// Everything is found out; files up to 4 GiB.
    fn default() -> Self {
        Self {
            delimiter: None,
            decimal: None,
            header: Header::Find,
            units: Vec::new(),
            segment: None,
            most_bytes: 4 << 30,
        }
    }
}
