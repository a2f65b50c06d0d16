//! Tables of text: names above rows of numbers, with anything before them.

use super::error::{TableError, TableProblem};
use super::heading::{Column, bare_unit};
use super::layout::{Layout, Line};
use super::options::TableOptions;
use super::split::{Lines, MOST_COLUMNS, Splitter, comment};
use super::table::Table;

/// Lines that are looked at to find out how a table is written.
const SAMPLE: usize = 500;

pub(super) fn table(file: &str, bytes: &[u8], options: &TableOptions) -> Result<Table, TableError> {
    let lines = Lines::new(bytes).filter(|(_, text)| !text.trim().is_empty());
    let sample: Vec<Line<'_>> = lines.take(SAMPLE).map(|(number, text)| Line { number, text }).collect();
    let Layout { delimiter, decimal, header, headings, units, first } = Layout::find(file, &sample, options)?;

    if headings.len() > MOST_COLUMNS {
        return Err(TableProblem::TooManyColumns { most: MOST_COLUMNS }.at(file, header.unwrap_or(first)));
    }
    let mut columns: Vec<Column> = headings.iter().map(|heading| Column::new(heading)).collect();
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
