//! LabVIEW measurement files (.lvm).
//!
//! A header of the file and headers of segments, `key<separator>value...`, each ended by `***End_of_Header***`; then a line of names
//! and rows up to a blank line (National Instruments, "Specification for the LabVIEW Measurement File").

use super::error::{TableError, TableProblem};
use super::heading::Column;
use super::number::{has_fraction, number};
use super::options::{Decimal, Delimiter, TableOptions};
use super::split::{Lines, MOST_COLUMNS, Splitter};
use super::table::{MOST_NOTES, Note, Table};
use std::iter::Peekable;
use std::sync::Arc;

const END: &str = "***End_of_Header***";
const X: &str = "X_Value";
const COMMENT: &str = "Comment";

pub(super) fn is_lvm(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LabVIEW Measurement")
}

/// The header of the file: how the rest is written.
struct Format {
    delimiter: Delimiter,
    decimal: Decimal,
    /// The first column is empty: x follows from `X0` and `Delta_X`.
    without_x: bool,
    /// Held once: a file can have far more segments than its header has lines.
    notes: Arc<[Note]>,
}

/// The channels in the header of a segment.
#[derive(Default)]
struct Segment {
    units: Vec<String>,
    dimensions: Vec<String>,
    start: Vec<f64>,
    step: Vec<f64>,
    pairs: Vec<(u64, String, String)>,
}

struct Reader<'o, 't> {
    file: &'o str,
    lines: Peekable<Lines<'t>>,
    format: Format,
}

pub(super) fn tables(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Vec<Table>, TableError> {
    let mut lines = Lines::new(bytes).peekable();
    let format = Format::read(file, bytes, &mut lines, options)?;
    let mut reader = Reader { file, lines, format };
    let mut tables = Vec::new();
    while let Some(table) = reader.segment()? {
        tables.push(table);
    }
    if tables.is_empty() {
        return Err(TableProblem::Empty.at(file, None));
    }
    let Some(wanted) = options.segment else {
        return Ok(tables);
    };
    let count = tables.len();
    let table = wanted.checked_sub(1).and_then(|i| tables.into_iter().nth(i));
    table.map(|table| vec![table]).ok_or_else(|| TableProblem::Segments { segments: count }.at(file, None))
}

impl Format {
    fn read(
        file: &str,
        bytes: &[u8],
        lines: &mut Peekable<Lines<'_>>,
        options: &TableOptions,
    ) -> Result<Self, TableError> {
        let (mut separator, mut decimal, mut without_x) = (None, options.decimal, false);
        let mut notes = Vec::new();
        let mut last = 0;
        let mut ended = false;
        for (line, text) in lines {
            last = line;
            if text.starts_with(END) {
                ended = true;
                break;
            }
            // the separator itself stands between key and value of its own line, or its name does
            let Some((key, value)) = text.split_once(['\t', ',']) else { continue };
            let value = value.trim_matches(['\t', ' ']);
            match key {
                "Separator" => {
                    separator = Some(if value.starts_with("Tab") { Delimiter::Tab } else { Delimiter::Comma })
                }
                "Decimal_Separator" if decimal.is_none() => {
                    decimal = Some(if value.starts_with('.') { Decimal::Point } else { Decimal::Comma });
                }
                "X_Columns" => without_x = value.trim_end_matches(',') == "No",
                _ => {}
            }
            if notes.len() < MOST_NOTES {
                notes.push(Note::new(key, value));
            }
        }
        if !ended {
            let what = format!("the file ends without `{END}`");
            return Err(TableProblem::Lvm { what, expected: "the end of the header of the file" }.at(file, last));
        }
        let delimiter = options.delimiter.or(separator).unwrap_or(Delimiter::Tab);
        let decimal =
            decimal.unwrap_or_else(|| if delimiter == Delimiter::Comma { Decimal::Point } else { mark(bytes) });
        Ok(Self { delimiter, decimal, without_x, notes: notes.into() })
    }
}

/// The decimal mark of the rows where the header does not tell.
fn mark(bytes: &[u8]) -> Decimal {
    let numbers = |decimal| {
        let lines = Lines::new(bytes).skip_while(|(_, text)| !text.starts_with(X)).take(100);
        lines.map(|(_, text)| text.split('\t').filter(|cell| has_fraction(cell.trim(), decimal)).count()).sum::<usize>()
    };
    if numbers(Decimal::Comma) > numbers(Decimal::Point) { Decimal::Comma } else { Decimal::Point }
}

impl<'t> Reader<'_, 't> {
    /// The next segment that names columns.
    fn segment(&mut self) -> Result<Option<Table>, TableError> {
        let mut splitter = Splitter::without_quotes(self.format.delimiter);
        let mut header = Segment::default();
        let mut special = false;
        while let Some((line, text)) = self.lines.next() {
            // blocks that other programs put there
            if text.starts_with("***Start_Special***") || text.starts_with("***End_Special***") {
                special = text.starts_with("***Start");
            } else if special || text.starts_with(END) {
            } else if text.starts_with(X) {
                return self.rows(line, &text, &header, &mut splitter).map(Some);
            } else if !text.trim().is_empty() {
                let cells = splitter.cells(&text);
                header.take(line, &cells, self.format.decimal);
            }
        }
        match header.pairs.last() {
            Some((line, key, _)) => {
                let what = format!("the file ends in the header of a segment, after `{key}`");
                let expected = "a line that starts with X_Value and names the columns";
                Err(TableProblem::Lvm { what, expected }.at(self.file, *line))
            }
            None => Ok(None),
        }
    }

    fn rows(&mut self, line: u64, names: &str, header: &Segment, splitter: &mut Splitter) -> Result<Table, TableError> {
        let mut names = splitter.cells(names);
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        if names.len() > MOST_COLUMNS {
            return Err(TableProblem::TooManyColumns { most: MOST_COLUMNS }.at(self.file, line));
        }
        let commented = names.last().is_some_and(|name| name == COMMENT);
        let columns = header.columns(&names);
        let mut table = Table::new(self.file, columns, Some(line));
        table.share_notes(&self.format.notes);
        for (_, key, value) in &header.pairs {
            table.add_pair(key, value);
        }
        while let Some((line, text)) = self.lines.next_if(|(_, text)| !ends(text)) {
            table.add_row(line, &text, splitter, self.format.decimal, usize::from(commented));
        }
        self.skip_blank();
        if self.format.without_x {
            let (start, step) = header.spacing(self.file, line, names.len() - 1 - usize::from(commented))?;
            table.fill(0, |k| start + k as f64 * step);
        }
        Ok(table)
    }

    fn skip_blank(&mut self) {
        while self.lines.next_if(|(_, text)| text.trim().is_empty()).is_some() {}
    }
}

/// Whether a line ends the rows: a blank one. With channels of different lengths rows may be nearly empty, but hold separators.
fn ends(text: &str) -> bool {
    text.is_empty() || text == "\t" || text == "," || text.chars().all(|c| c == ' ')
}

impl Segment {
    fn take(&mut self, line: u64, cells: &[String], decimal: Decimal) {
        let Some((key, values)) = cells.split_first() else { return };
        let numbers = || values.iter().map(|value| number(value, decimal).unwrap_or(f64::NAN)).collect();
        match key.as_str() {
            "Y_Unit_Label" => self.units = values.to_vec(),
            "X_Dimension" => self.dimensions = values.to_vec(),
            "X0" => self.start = numbers(),
            "Delta_X" => self.step = numbers(),
            _ => {}
        }
        let filled: Vec<&str> = values.iter().map(String::as_str).filter(|value| !value.is_empty()).collect();
        self.pairs.push((line, key.clone(), filled.join(" ")));
    }

    /// The columns as they are named, with the units of the channels; where each channel has an x of its own, those after the
    /// first are named after it. Values of a header follow its keys, so that they stand above the column before.
    fn columns(&self, names: &[String]) -> Vec<Column> {
        let mut columns = Vec::with_capacity(names.len());
        for (i, name) in names.iter().enumerate() {
            let mut column = Column::new(name);
            if name == X {
                if i > 0 {
                    column.name = format!("{X} of {}", names.get(i + 1).map_or("", String::as_str));
                }
                let time = self.dimensions.get(i).is_some_and(|dimension| dimension == "Time");
                column.unit = time.then(|| "s".to_owned());
            } else if let Some(unit) =
                i.checked_sub(1).and_then(|i| self.units.get(i)).filter(|unit| !unit.is_empty() && name != COMMENT)
            {
                if column.unit.as_ref() != Some(unit) {
                    column.name.clone_from(name);
                }
                column.unit = Some(unit.clone());
            }
            columns.push(column);
        }
        columns
    }

    /// `X0` and `Delta_X`, which all channels must share where there is no column of x.
    fn spacing(&self, file: &str, line: u64, channels: usize) -> Result<(f64, f64), TableError> {
        let expected = "X0 and Delta_X above, the same for all channels, for there is no column of x";
        let wrong = |what: String| TableProblem::Lvm { what, expected }.at(file, line);
        let shared = |key: &str, values: &[f64]| match values.first() {
            Some(first) if first.is_finite() => {
                let other = values.iter().take(channels).find(|value| *value != first);
                other.map_or(Ok(*first), |other| Err(wrong(format!("{key} is {first} and {other}"))))
            }
            _ => Err(wrong(format!("{key} is missing"))),
        };
        Ok((shared("X0", &self.start)?, shared("Delta_X", &self.step)?))
    }
}
