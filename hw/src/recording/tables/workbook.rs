//! Workbooks of spreadsheets (.xlsx): the sheet as lines of text, which are read as any other table.

use super::error::{TableError, TableProblem};
use super::options::TableOptions;

/// The sheet with the table, cells separated by tabs; its rows are the lines.
#[cfg(not(feature = "xlsx"))]
pub(super) fn text(file: &str, _bytes: &[u8], _options: &TableOptions) -> Result<Vec<u8>, TableError> {
    let what = "this build has no feature `xlsx`".to_owned();
    Err(TableProblem::Workbook { what }.at(file, None))
}

/// The sheet with the table, cells separated by tabs; its rows are the lines.
#[cfg(feature = "xlsx")]
pub(super) fn text(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Vec<u8>, TableError> {
    sheet::text(bytes, options).map_err(|problem| problem.at(file, None))
}

#[cfg(feature = "xlsx")]
mod sheet {
    use super::super::number::{has_fraction, number};
    use super::super::options::Decimal;
    use super::super::split::MOST_COLUMNS;
    use super::{TableOptions, TableProblem};
    use calamine::{DataRef, Reader, Xlsx};
    use std::fmt::Write;
    use std::io::Cursor;

    /// A sheet as lines, from the first row of the sheet on.
    struct Lines {
        text: String,
        /// Row of the last line, from 0, and the next column of it.
        row: u32,
        column: u32,
        has_numbers: bool,
    }

    pub fn text(bytes: &[u8], options: &TableOptions) -> Result<Vec<u8>, TableProblem> {
        let unreadable = |error: calamine::XlsxError| TableProblem::Workbook { what: error.to_string() };
        let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(unreadable)?;
        let mut sheets: Vec<(String, String)> = Vec::new();
        for name in book.sheet_names() {
            // sheets of charts have no cells
            let Ok(mut cells) = book.worksheet_cells_reader(&name) else { continue };
            let mut lines = Lines { text: String::new(), row: 0, column: 0, has_numbers: false };
            while let Some(cell) = cells.next_cell().map_err(unreadable)? {
                lines.add(cell.get_position(), cell.get_value());
                // an archive may hold far more than its size
                if lines.text.len() as u64 > options.most_bytes {
                    return Err(TableProblem::TooLong { most: options.most_bytes });
                }
            }
            if lines.has_numbers {
                lines.text.push('\n');
                sheets.push((name, lines.text));
            }
        }
        let count = sheets.len();
        let wanted = match options.segment {
            None if count > 1 => {
                return Err(TableProblem::Sheets { names: sheets.into_iter().map(|sheet| sheet.0).collect() });
            }
            None => Some(0),
            Some(number) => number.checked_sub(1),
        };
        match wanted.and_then(|wanted| sheets.into_iter().nth(wanted)) {
            Some((_, text)) => Ok(text.into_bytes()),
            None if count == 0 => Err(TableProblem::Empty),
            None => Err(TableProblem::Segments { segments: count }),
        }
    }

    impl Lines {
        fn add(&mut self, (row, column): (u32, u32), value: &DataRef<'_>) {
            // cells come row by row; a stray one far to the right is no column
            if matches!(value, DataRef::Empty)
                || (row, column) < (self.row, self.column)
                || column as usize > MOST_COLUMNS
            {
                return;
            }
            if row > self.row {
                self.text.extend(std::iter::repeat_n('\n', (row - self.row) as usize));
                (self.row, self.column) = (row, 0);
            }
            self.text.extend(std::iter::repeat_n('\t', column.saturating_sub(self.column) as usize));
            self.column = column;
            match number_of(value) {
                Some(value) => {
                    self.has_numbers = true;
                    let _ = write!(self.text, "{value:?}");
                }
                None => self.text.extend(
                    text_of(value).chars().map(
                        |letter| {
                            if letter.is_control() || letter == '"' { ' ' } else { letter }
                        },
                    ),
                ),
            }
        }
    }

    /// The number in a cell, also where it is kept as text; dates count as days.
    fn number_of(value: &DataRef<'_>) -> Option<f64> {
        match value {
            DataRef::Int(value) => Some(*value as f64),
            DataRef::Float(value) => Some(*value),
            DataRef::DateTime(date) => Some(date.as_f64()),
            _ => {
                let text = text_of(value).trim();
                let decimal = if has_fraction(text, Decimal::Comma) { Decimal::Comma } else { Decimal::Point };
                number(text, decimal)
            }
        }
    }

    fn text_of<'v>(value: &'v DataRef<'_>) -> &'v str {
        match value {
            DataRef::String(text) | DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => text,
            DataRef::SharedString(text) => text,
            _ => "",
        }
    }
}
