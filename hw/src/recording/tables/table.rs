//! Named columns of numbers, row by row.

use super::date;
use super::fault::{RowFault, RowProblem};
use super::heading::Column;
use super::number::number;
use super::options::{Constant, Decimal};
use super::split::{Splitter, comment};
use std::sync::Arc;

/// Named columns with their units, and rows of cells with their lines in the file.
///
/// Read from text: CSV, TSV, separated by semicolons or blanks, or LabVIEW's LVM. What separates cells and fractions and which
/// line names the columns is found out, or given in the [options](super::TableOptions); ambiguous files are refused.
///
/// ```
/// use rod_hw::recording::{Cell, Table, TableOptions};
/// let text = "Scan 3 of the parabola\r\n\r\nt [s];Fx [mN];note\r\n0,0;1,5;start\r\n0,1;;\r\n0,2;2,\r\n";
/// let table = Table::parse("scan.csv", text.as_bytes(), &TableOptions::default())?;
/// assert_eq!((table.columns()[1].name.as_str(), table.columns()[1].unit.as_deref()), ("Fx", Some("mN")));
/// let first = table.rows().nth(0).ok_or("no row")?;
/// assert_eq!((first.line(), first.cell(1), first.cell(2)), (4, Cell::Number(1.5), Cell::Text("start")));
/// let problems: Vec<String> = table.rows().filter_map(|row| row.number(1).err()).map(|p| p.to_string()).collect();
/// assert_eq!(problems, ["Fx is empty, expected a number", "the number of cells is 2, expected 3"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    pub(super) file: String,
    pub(super) columns: Vec<Column>,
    pub(super) header_line: Option<u64>,
    /// Of the header of the file, which all its segments share.
    common: Arc<[Note]>,
    notes: Vec<Note>,
    heads: Vec<Head>,
    cells: Vec<Stored>,
    texts: Vec<Box<str>>,
    /// The last columns, which the file lacks.
    constants: Vec<f64>,
    /// Which columns have dates or times of day, read in s.
    dated: Vec<bool>,
    pub(super) cut: bool,
}

/// A line beside the table: `key: value` of a comment or of a header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Note {
    /// The subject; empty if it is not given.
    pub key: String,
    /// The text.
    pub text: String,
}

impl Note {
    pub fn new(key: &str, text: &str) -> Self {
        Self { key: key.trim().to_owned(), text: text.trim().to_owned() }
    }
}

/// The content of one place of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'t> {
    /// A number, perhaps one that is not finite.
    Number(f64),
    /// Nothing.
    Empty,
    /// Something else.
    Text(&'t str),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stored {
    Number(f64),
    Empty,
    /// Which one of the texts.
    Text(u32),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Head {
    line: u64,
    /// How many cells the line has.
    found: u32,
    /// Where the cells are; a row of another number of them has none.
    start: Option<usize>,
}

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'t> {
    table: &'t Table,
    head: Head,
}

/// Notes that are kept; so many lines say nothing to a person.
pub(super) const MOST_NOTES: usize = 4096;

impl Table {
    pub(super) fn new(file: &str, columns: Vec<Column>, header_line: Option<u64>) -> Self {
        Self {
            file: file.to_owned(),
            columns,
            header_line,
            common: Arc::default(),
            notes: Vec::new(),
            heads: Vec::new(),
            cells: Vec::new(),
            texts: Vec::new(),
            constants: Vec::new(),
            dated: Vec::new(),
            cut: false,
        }
    }

    /// The name of the file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The columns from left to right.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Line of the names, from 1, if there is one.
    pub fn header_line(&self) -> Option<u64> {
        self.header_line
    }

    /// How many rows there are, those of a wrong number of cells included.
    pub fn len(&self) -> usize {
        self.heads.len()
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.heads.is_empty()
    }

    /// All rows.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = Row<'_>> + Clone {
        self.heads.iter().map(|head| Row { table: self, head: *head })
    }

    /// Comments, and what headers say, in order.
    pub(super) fn notes(&self) -> impl Iterator<Item = &Note> + Clone {
        self.common.iter().chain(&self.notes)
    }

    /// The message on this, at its first occurrence.
    pub fn note(&self, key: &str) -> Option<&str> {
        self.notes().find(|note| note.key == key).map(|note| note.text.as_str())
    }

    /// The fault of rows with a wrong number of cells.
    pub fn faults(&self) -> impl Iterator<Item = RowFault> {
        self.rows().filter_map(|row| row.check().err().map(|problem| RowFault { line: row.line(), problem }))
    }

    /// Puts notes in front that other tables have, too.
    pub(super) fn share_notes(&mut self, notes: &Arc<[Note]>) {
        self.common = Arc::clone(notes);
    }

    /// Makes room for about so many rows of a text of so many bytes.
    pub(super) fn reserve(&mut self, rows: usize, bytes: usize) {
        self.heads.reserve(rows);
        // a cell has a byte and a delimiter at least, whatever the first rows look like
        self.cells.reserve(rows.saturating_mul(self.columns.len()).min(bytes / 2));
    }

    pub(super) fn add_note(&mut self, text: &str) {
        let (key, text) = text.split_once(": ").unwrap_or(("", text));
        self.add_pair(key, text);
    }

    pub(super) fn add_pair(&mut self, key: &str, text: &str) {
        if self.notes.len() < MOST_NOTES {
            self.notes.push(Note::new(key, text));
        }
    }

    /// Adds rows of a text, comments and blank lines aside.
    pub(super) fn add_line(&mut self, line: u64, text: &str, splitter: &mut Splitter, decimal: Decimal) {
        if let Some(comment) = comment(text) {
            self.add_note(comment);
        } else if !text.trim().is_empty() {
            self.add_row(line, text, splitter, decimal, 0);
        }
    }

    /// Adds a row, of which the last cells may be missing.
    pub(super) fn add_row(
        &mut self,
        line: u64,
        text: &str,
        splitter: &mut Splitter,
        decimal: Decimal,
        optional: usize,
    ) {
        let (start, width) = (self.cells.len(), self.columns.len());
        let mut extra = false;
        let found = splitter.each(text, |i, cell| {
            if i >= width {
                // empty cells at the end do no harm
                extra |= !cell.is_empty();
            } else {
                let stored = self.stored(i, cell, decimal);
                self.cells.push(stored);
            }
        });
        if extra || found + optional < width {
            self.cells.truncate(start);
            let found = u32::try_from(found).unwrap_or(u32::MAX);
            self.heads.push(Head { line, found, start: None });
        } else {
            self.cells.resize(start + width, Stored::Empty);
            self.heads.push(Head { line, found: width as u32, start: Some(start) });
        }
    }

    /// What a cell holds.
    fn stored(&mut self, column: usize, cell: &str, decimal: Decimal) -> Stored {
        if cell.is_empty() {
            return Stored::Empty;
        }
        if let Some(value) = number(cell, decimal) {
            return Stored::Number(value);
        }
        if let Some(value) = date::seconds(cell) {
            self.dated.resize(self.dated.len().max(column + 1), false);
            self.dated[column] = true;
            return Stored::Number(value);
        }
        // flags and remarks are often those of the row before
        if self.texts.last().is_none_or(|last| **last != *cell) {
            self.texts.push(cell.into());
        }
        // more than 2^32 texts are not in a file of 4 GiB
        Stored::Text(u32::try_from(self.texts.len() - 1).unwrap_or(u32::MAX))
    }

    /// Whether a column has dates or times of day: they are read in s, since 1970 or since midnight.
    pub fn is_dated(&self, column: usize) -> bool {
        self.dated.get(column).copied().unwrap_or_default()
    }

    /// States the unit of columns of dates.
    pub(super) fn take_dates(&mut self) {
        for (column, _) in self.columns.iter_mut().zip(&self.dated).filter(|(_, is_dated)| **is_dated) {
            column.unit = Some("s".to_owned());
        }
    }

    /// Appends columns that stay the same. No row is added after that.
    pub(super) fn take_constants(&mut self, constants: &[Constant]) {
        for Constant { role, value, unit } in constants {
            self.columns.push(Column::new(&format!("{role} [{unit}]")));
            self.constants.push(*value);
        }
    }

    /// How many columns the file has.
    fn width(&self) -> usize {
        self.columns.len() - self.constants.len()
    }

    /// Puts a number into all rows, from the first.
    pub(super) fn fill(&mut self, column: usize, value: impl Fn(usize) -> f64) {
        for (k, head) in self.heads.iter().enumerate() {
            if let Some(cell) = head.start.and_then(|start| self.cells.get_mut(start + column)) {
                *cell = Stored::Number(value(k));
            }
        }
    }
}

impl<'t> Row<'t> {
    /// Its line in the file, from 1.
    pub fn line(&self) -> u64 {
        self.head.line
    }

    /// The cell in a column; empty in a row of a wrong number of cells, and beyond the columns.
    pub fn cell(&self, column: usize) -> Cell<'t> {
        let width = self.table.width();
        if let Some(value) = column.checked_sub(width).and_then(|constant| self.table.constants.get(constant)) {
            return if self.head.start.is_some() { Cell::Number(*value) } else { Cell::Empty };
        }
        let place = self.head.start.filter(|_| column < width).map(|start| start + column);
        match place.and_then(|place| self.table.cells.get(place)) {
            Some(Stored::Number(value)) => Cell::Number(*value),
            Some(Stored::Text(i)) => Cell::Text(self.table.texts.get(*i as usize).map_or("", |text| text)),
            Some(Stored::Empty) | None => Cell::Empty,
        }
    }

    /// Whether the row has as many cells as there are columns.
    ///
    /// # Errors
    /// [`RowProblem::Cells`].
    pub fn check(&self) -> Result<(), RowProblem> {
        match self.head.start {
            Some(_) => Ok(()),
            None => {
                let last = self.table.heads.last().is_some_and(|last| last.line == self.head.line);
                let (found, expected) = (self.head.found as usize, self.table.width());
                Err(RowProblem::Cells { found, expected, cut: last && self.table.cut })
            }
        }
    }

    /// The finite number in a column, in the column's unit.
    ///
    /// # Errors
    /// [`RowProblem`]: the row has a wrong number of cells, or there is no number or one that is not finite.
    pub fn number(&self, column: usize) -> Result<f64, RowProblem> {
        self.check()?;
        let name = || self.table.columns.get(column).map_or_else(|| (column + 1).to_string(), |c| c.name.clone());
        match self.cell(column) {
            Cell::Number(value) if value.is_finite() => Ok(value),
            Cell::Number(value) => Err(RowProblem::NotFinite { column: name(), value }),
            Cell::Empty => Err(RowProblem::Missing { column: name() }),
            Cell::Text(text) => Err(RowProblem::no_number(name(), text)),
        }
    }
}
