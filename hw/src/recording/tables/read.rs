//! From a file to its tables.

use super::error::{TableError, TableProblem, listed};
use super::heading::{Column, bare_unit};
use super::layout::{Layout, Line};
use super::lvm;
use super::options::{Decimal, Delimiter, TableOptions};
use super::split::{Lines, MOST_COLUMNS, Splitter, comment};
use super::table::Table;
use super::workbook;
use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

impl Table {
    /// The table in a file.
    ///
    /// # Errors
    /// [`TableError`]; also where an LVM file has several segments and the options do not say which.
    pub fn read(file: &Path, options: &TableOptions) -> Result<Self, TableError> {
        let name = file.display().to_string();
        Self::parse(&name, &bytes(file, &name, options)?, options)
    }

    /// The table in a text. `file` names it in messages; it is not opened.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Self, TableError> {
        let mut tables = Self::parse_all(file, bytes, options)?;
        match (tables.len(), tables.pop()) {
            (1, Some(table)) => Ok(table),
            (segments, _) => Err(TableProblem::Segments { segments }.at(file, None)),
        }
    }

    /// All tables in a file: the segments of an LVM file, or the only one.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn read_all(file: &Path, options: &TableOptions) -> Result<Vec<Self>, TableError> {
        let name = file.display().to_string();
        Self::parse_all(&name, &bytes(file, &name, options)?, options)
    }

    /// All tables in a text.
    ///
    /// # Errors
    /// As [`read_all`](Self::read_all).
    pub fn parse_all(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Vec<Self>, TableError> {
        let whole = bytes;
        let options = &*as_written(whole, options);
        let bytes = &*text_of(file, bytes, options)?;
        if let Some(zero) = bytes.iter().position(|byte| *byte == 0) {
            let line = 1 + bytes[..zero].iter().filter(|byte| **byte == b'\n').count() as u64;
            return Err(TableProblem::Binary.at(file, Some(line)));
        }
        let mut tables = if lvm::is_lvm(bytes) {
            lvm::tables(file, bytes, options)?
        } else if let Some(segment) = options.segment.filter(|_| !is_workbook(whole)) {
            return Err(TableProblem::NoSegments { segment }.at(file, None));
        } else {
            vec![text_table(file, bytes, options)?]
        };
        for table in &mut tables {
            table.cut = !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r");
            table.take_dates();
            table.take_constants(&options.constants);
            table.take_units(&options.units)?;
        }
        Ok(tables)
    }

    /// Takes the units that the options give.
    fn take_units(&mut self, units: &[(String, String)]) -> Result<(), TableError> {
        for (name, unit) in units {
            let mut any = false;
            for column in self.columns.iter_mut().filter(|column| column.is(name)) {
                column.unit = Some(unit.clone());
                any = true;
            }
            if !any {
                let found = listed(self.columns.iter().map(|column| column.heading.as_str()));
                return Err(TableProblem::NoColumnOfUnit { column: name.clone(), found }.at(&self.file, None));
            }
        }
        Ok(())
    }
}

/// Whether this is a workbook of a spreadsheet: an archive (ZIP), which no text begins like.
pub(super) fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

/// The options for a file: the text of a workbook is written by `workbook`, whatever its own decimal mark is.
pub(super) fn as_written<'o>(whole: &[u8], options: &'o TableOptions) -> Cow<'o, TableOptions> {
    if !is_workbook(whole) {
        return Cow::Borrowed(options);
    }
    Cow::Owned(TableOptions { delimiter: Some(Delimiter::Tab), decimal: Some(Decimal::Point), ..options.clone() })
}

/// The text of a file in UTF-8, without a mark at its start; of a workbook that of its sheet.
pub(super) fn text_of<'b>(file: &str, bytes: &'b [u8], options: &TableOptions) -> Result<Cow<'b, [u8]>, TableError> {
    if is_workbook(bytes) {
        return workbook::text(file, bytes, options).map(Cow::Owned);
    }
    Ok(match utf8(bytes) {
        Cow::Borrowed(bytes) => Cow::Borrowed(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)),
        owned => owned,
    })
}

/// The text in UTF-8 where its mark says that it has two bytes a letter, as spreadsheets write it.
fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let (letters, letter): (_, fn([u8; 2]) -> u16) = match bytes {
        [0xff, 0xfe, letters @ ..] => (letters, u16::from_le_bytes),
        [0xfe, 0xff, letters @ ..] => (letters, u16::from_be_bytes),
        _ => return Cow::Borrowed(bytes),
    };
    let letters = letters.chunks_exact(2).map(|pair| letter([pair[0], pair[1]]));
    let text: String =
        char::decode_utf16(letters).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text.into_bytes())
}

pub(super) fn bytes(file: &Path, name: &str, options: &TableOptions) -> Result<Vec<u8>, TableError> {
    let unreadable = |source| TableProblem::Unreadable(source).at(name, None);
    let mut bytes = Vec::new();
    let input = std::fs::File::open(file).map_err(unreadable)?;
    let length = input.metadata().map_or(0, |data| data.len());
    // what may be read, and one more byte to see that there is more
    let most = options.most_bytes;
    if length <= most {
        input.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    if length > most || bytes.len() as u64 > most {
        return Err(TableProblem::TooLong { most }.at(name, None));
    }
    Ok(bytes)
}

/// Lines that are looked at to find out how a table is written.
pub(super) const SAMPLE: usize = 500;

/// A table of text: names above rows of numbers, with anything before them.
fn text_table(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Table, TableError> {
    let lines = Lines::new(bytes).filter(|(_, text)| !text.trim().is_empty());
    let sample: Vec<Line<'_>> = lines.take(SAMPLE).map(|(number, text)| Line { number, text }).collect();
    let Layout { delimiter, decimal, header, headings, units, first, .. } = Layout::find(file, &sample, options)?;

    if headings.len() > MOST_COLUMNS {
        return Err(TableProblem::TooManyColumns { most: MOST_COLUMNS }.at(file, header.unwrap_or(first)));
    }
    let name = |(k, heading): (usize, &String)| match heading.is_empty() {
        // options need a name
        true => Column::new(&format!("column {}", k + 1)),
        false => Column::new(heading),
    };
    let mut columns: Vec<Column> = headings.iter().enumerate().map(name).collect();
    for (column, unit) in columns.iter_mut().zip(units.iter().flatten().map(|unit| bare_unit(unit))) {
        if !matches!(unit, "" | "-") && column.unit.is_none() {
            column.unit = Some(unit.to_owned());
        }
    }
    let mut table = Table::new(file, columns, header);
    let length: usize = sample.iter().map(|line| line.text.len() + 1).sum();
    table.reserve(bytes.len() / (length / sample.len().max(1)).max(1), bytes.len());
    let mut splitter = Splitter::new(delimiter);
    for (number, text) in Lines::new(bytes) {
        if number >= first {
            table.add_line(number, &text, &mut splitter, decimal);
        } else if Some(number) != header && !text.trim().is_empty() {
            table.add_note(comment(&text).unwrap_or(&text));
        }
    }
    Ok(table)
}
