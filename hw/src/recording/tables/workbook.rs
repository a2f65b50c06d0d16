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
    use super::{TableOptions, TableProblem};
    use calamine::{Data, DataType, Range, Reader, Xlsx};
    use std::fmt::Write;
    use std::io::Cursor;

    /// Rows that a sheet may have (of the format).
    const MOST_ROWS: u32 = 1_048_576;

    pub fn text(bytes: &[u8], options: &TableOptions) -> Result<Vec<u8>, TableProblem> {
        let unreadable = |error: calamine::XlsxError| TableProblem::Workbook { what: error.to_string() };
        let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(unreadable)?;
        let mut sheets: Vec<(String, Range<Data>)> = Vec::new();
        for name in book.sheet_names() {
            // sheets of charts have no cells
            let Ok(range) = book.worksheet_range(&name) else { continue };
            if range.used_cells().any(|(_, _, cell)| value(cell).is_some()) {
                sheets.push((name, range));
            }
        }
        let wanted = match options.segment {
            Some(number) => number.checked_sub(1),
            None if sheets.len() > 1 => {
                return Err(TableProblem::Sheets { names: sheets.into_iter().map(|sheet| sheet.0).collect() });
            }
            None => Some(0),
        };
        let count = sheets.len();
        match wanted.and_then(|wanted| sheets.into_iter().nth(wanted)) {
            Some((_, range)) => Ok(lines(&range)),
            None if count == 0 => Err(TableProblem::Empty),
            None => Err(TableProblem::Segments { segments: count }),
        }
    }

    /// The number in a cell, also where it is kept as text; dates count as days.
    fn value(cell: &Data) -> Option<f64> {
        match cell {
            Data::Int(value) => Some(*value as f64),
            Data::Float(value) => Some(*value),
            Data::DateTime(date) => Some(date.as_f64()),
            Data::String(text) => as_number(text),
            _ => None,
        }
    }

    fn as_number(text: &str) -> Option<f64> {
        let text = text.trim();
        let decimal = if has_fraction(text, Decimal::Comma) { Decimal::Comma } else { Decimal::Point };
        number(text, decimal)
    }

    fn lines(range: &Range<Data>) -> Vec<u8> {
        let ((top, _), mut text) = (range.start().unwrap_or_default(), String::new());
        // lines are the rows of the sheet, also where the first ones are empty
        text.extend(std::iter::repeat_n('\n', top.min(MOST_ROWS) as usize));
        for row in range.rows() {
            for (number, cell) in row.iter().enumerate() {
                if number > 0 {
                    text.push('\t');
                }
                match value(cell) {
                    Some(value) => {
                        let _ = write!(text, "{value:?}");
                    }
                    None => text.extend(
                        cell.as_string()
                            .unwrap_or_default()
                            .chars()
                            .map(|letter| if letter.is_control() || letter == '"' { ' ' } else { letter }),
                    ),
                }
            }
            text.push('\n');
        }
        text.into_bytes()
    }
}
