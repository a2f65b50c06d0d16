//! How a file of a table is laid out: format, separator, decimal mark, lines of the header, further tables in it.

use super::error::{TableError, TableProblem};
use super::layout::{Layout, Line};
use super::lvm::is_lvm;
use super::number::number;
use super::options::{Decimal, Delimiter, TableOptions};
use super::read::{SAMPLE, as_written, bytes, is_workbook, text_of};
use super::split::{Lines, Splitter, comment};
use std::path::Path;

/// The format of a file with a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// Text.
    Text,
    /// LabVIEW's measurement file.
    Lvm,
    /// A spreadsheet's workbook.
    Workbook,
}

/// A table within a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Line of its names.
    pub line: u64,
    /// Its names.
    pub names: Vec<String>,
}

/// How a file of a table is laid out.
///
/// ```
/// use rod_hw::recording::{Decimal, Delimiter, Outline, TableOptions};
/// let text = "Scan 3\nZeit;Kraft X\ns;mN\n0,0;1,5\n0,1;1,6\n";
/// let outline = Outline::parse("scan.csv", text.as_bytes(), &TableOptions::default())?;
/// assert_eq!((outline.delimiter, outline.decimal), (Delimiter::Semicolon, Decimal::Comma));
/// assert_eq!((outline.header, outline.units, outline.first), (Some(2), Some(3), 4));
/// # Ok::<(), rod_hw::recording::TableError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outline {
    /// The format.
    pub format: FileFormat,
    /// The separator of the cells; absent for a workbook and an LVM file, which state it.
    pub delimiter: Delimiter,
    /// The mark before fractions.
    pub decimal: Decimal,
    /// Line of the names, if there is one.
    pub header: Option<u64>,
    /// Line of the units, if there is one.
    pub units: Option<u64>,
    /// First line below the header.
    pub first: u64,
    /// Tables below the first one.
    pub below: Vec<Part>,
    /// Tables beside the first one: behind a column without name and values.
    pub beside: Vec<Part>,
}

/// Rows that a table below another one has at least.
const FEWEST_BELOW: usize = 2;
/// Most rows of text between the names of a table below another one and its rows: units and remarks.
const MOST_TEXT: usize = 4;

impl Outline {
    /// The outline of a file.
    ///
    /// # Errors
    /// [`TableError`], as where the table is read.
    pub fn read(file: &Path, options: &TableOptions) -> Result<Self, TableError> {
        let name = file.display().to_string();
        Self::parse(&name, &bytes(file, &name, options)?, options)
    }

    /// The outline of the contents of a file. `file` names it in messages; it is not opened.
    ///
    /// # Errors
    /// [`TableError`], as where the table is read.
    pub fn parse(file: &str, whole: &[u8], options: &TableOptions) -> Result<Self, TableError> {
        let options = &*as_written(whole, options);
        let text = &*text_of(file, whole, options)?;
        if is_lvm(text) {
            return Ok(Self {
                format: FileFormat::Lvm,
                delimiter: Delimiter::Tab,
                decimal: Decimal::Point,
                header: None,
                units: None,
                first: 1,
                below: Vec::new(),
                beside: Vec::new(),
            });
        }
        if text.contains(&0) {
            return Err(TableProblem::Binary.at(file, None));
        }
        let lines = Lines::new(text).filter(|(_, text)| !text.trim().is_empty());
        let sample: Vec<Line<'_>> = lines.take(SAMPLE).map(|(number, text)| Line { number, text }).collect();
        let found = Layout::find(file, &sample, options)?;
        Ok(Self {
            format: if is_workbook(whole) { FileFormat::Workbook } else { FileFormat::Text },
            delimiter: found.delimiter,
            decimal: found.decimal,
            header: found.header,
            units: found.units_line,
            first: found.first,
            below: below(text, &found),
            beside: beside(&found, &sample),
        })
    }
}

/// Tables below the first one: lines of names with rows of numbers below them.
fn below(text: &[u8], layout: &Layout) -> Vec<Part> {
    let mut splitter = Splitter::new(layout.delimiter);
    let mut parts: Vec<Part> = Vec::new();
    // the last line of names, how many lines of text followed it, and how many rows of numbers
    let mut open: Option<(Part, usize, usize)> = None;
    let mut rows = 0;
    for (line, text) in Lines::new(text).filter(|(number, _)| *number >= layout.first) {
        if text.trim().is_empty() || comment(&text).is_some() {
            continue;
        }
        // most lines are rows of numbers, and need not be cut into cells
        let like_number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | '\'');
        if text.trim_start_matches([' ', '"', '\t']).starts_with(like_number) {
            rows += 1;
            if let Some((part, _, found)) = &mut open {
                *found += 1;
                if *found >= FEWEST_BELOW {
                    parts.push(part.clone());
                    open = None;
                }
            }
            continue;
        }
        let names = splitter.cells(&text);
        let is_names =
            names.len() > 1 && names.iter().all(|name| number(name, layout.decimal).is_none() && !name.is_empty());
        open = match open {
            Some((part, lines, 0)) if lines < MOST_TEXT => Some((part, lines + 1, 0)),
            _ if is_names && rows > 0 => Some((Part { line, names }, 0, 0)),
            _ => None,
        };
    }
    parts
}

/// Tables beside the first one, by the first lines.
fn beside(layout: &Layout, lines: &[Line<'_>]) -> Vec<Part> {
    let Some(line) = layout.header else { return Vec::new() };
    let mut splitter = Splitter::new(layout.delimiter);
    let mut has_values = vec![false; layout.headings.len()];
    for line in lines.iter().filter(|line| line.number >= layout.first && comment(&line.text).is_none()) {
        let cells = splitter.cells(&line.text);
        has_values.iter_mut().zip(cells).for_each(|(has_values, cell)| *has_values |= !cell.is_empty());
    }
    // a column that only lacks its name parts nothing
    let columns: Vec<(&String, bool)> = layout.headings.iter().zip(has_values).collect();
    let is_gap = |(name, has_values): &(&String, bool)| name.is_empty() && !has_values;
    let groups = columns.split(is_gap).filter(|columns| !columns.is_empty()).skip(1);
    groups.map(|columns| Part { line, names: columns.iter().map(|column| column.0.clone()).collect() }).collect()
}
