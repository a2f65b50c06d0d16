//! How a table is written: given by the caller, or detected.

use super::role::Role;
use crate::sample::Unit;
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
    /// Columns that the file lacks because their value stays the same.
    pub constants: Vec<Constant>,
    /// Which of several segments of an LVM file, from 1.
    pub segment: Option<usize>,
    /// Files longer than this are refused, bytes. A table takes at most 100 times as much memory as its file, where rows are as
    /// short as can be, and less than 4 times where numbers have 15 digits.
    pub most_bytes: u64,
}

/// A value that stays the same along a recording, as the angle of a clamp that only moves. It is read as a column under the name of its role.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// What it is.
    pub role: Role,
    /// Its value in the unit.
    pub value: f64,
    /// Its unit, as `deg`.
    pub unit: String,
}

impl Constant {
    /// From a number and a unit of the role, as `90 deg`; none of any other text.
    ///
    /// ```
    /// use rod_hw::recording::{Constant, Role, Table, TableOptions};
    /// let constants = Vec::from_iter(Constant::parse(Role::Phi0, "90 deg"));
    /// let table = Table::parse("r.csv", b"x0,y0\n0,0\n1,0\n", &TableOptions { constants, ..TableOptions::default() })?;
    /// assert_eq!(table.columns()[2].heading, "phi0 [deg]");
    /// assert_eq!(table.rows().nth(1).map(|row| row.number(2)), Some(Ok(90.0)));
    /// assert_eq!(Constant::parse(Role::Phi0, "angle"), None);
    /// # Ok::<(), rod_hw::recording::TableError>(())
    /// ```
    pub fn parse(role: Role, text: &str) -> Option<Self> {
        let dimension = role.dimension()?;
        let parts = text.char_indices().skip(1).map(|(at, _)| text.split_at(at));
        parts.map(|(value, unit)| (value.trim().parse::<f64>(), unit.trim())).find_map(|(value, unit)| {
            let value = value.ok().filter(|value| value.is_finite())?;
            Unit::parse(unit, dimension).ok().map(|_| Self { role, value, unit: unit.to_owned() })
        })
    }
}

impl Default for TableOptions {
    /// Everything is found out; files up to 4 GiB.
    fn default() -> Self {
        Self {
            delimiter: None,
            decimal: None,
            header: Header::Find,
            units: Vec::new(),
            constants: Vec::new(),
            segment: None,
            most_bytes: 4 << 30,
        }
    }
}
