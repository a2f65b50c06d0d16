//! Times and rows of a table: rate, gaps, repeated rows, cells that are no numbers.

use super::report::InspectedFile;
use super::values::factor;
use crate::table::counted;
use vibrissa::hw::recording::{Cell, Quantity, Role, Row, RowProblem, Table, TableGuess};

/// Steps of the time beyond this many usual ones are gaps.
const GAP: f64 = 1.5;

/// Describes the rows, and names their faults.
pub(super) fn rows(file: &mut InspectedFile, table: &Table, guess: &TableGuess) {
    file.fact("rows", table.len().to_string());
    times(file, table, guess);
    let repeated = repeated(table, guess);
    if let Some(line) = repeated.1 {
        let count = counted(repeated.0, "row");
        file.fact("repeated rows", format!("{count} with the values of the row before, the first in line {line}"));
    }
    cells(file, table, guess);
}

fn times(file: &mut InspectedFile, table: &Table, guess: &TableGuess) {
    let Some(column) = guess.of(Role::Time) else { return };
    let factor = factor(column);
    let name = &table.columns()[column.column].name;
    let step = factor * column.values.step;
    if step > 0.0 {
        let known = if column.unit.is_some() { "" } else { ", if it is in s" };
        file.fact(
            "rate",
            format!("{:.6} Hz over {:.4} s, by `{name}`{known}", 1.0 / step, factor * column.values.range()),
        );
    }
    let (mut gaps, mut longest, mut at) = (0, 0.0, 0);
    let (mut late, mut late_at) = (0, None);
    let mut last: Option<f64> = None;
    for row in table.rows() {
        let Cell::Number(value) = row.cell(column.column) else { continue };
        let time = factor * value;
        if let Some(before) = last {
            if time <= before {
                late += 1;
                late_at = late_at.or(Some((row.line(), value)));
            } else if time - before > GAP * step {
                gaps += 1;
                if time - before > longest {
                    (longest, at) = (time - before, row.line());
                }
            }
        }
        last = Some(time);
    }
    if gaps > 0 {
        file.fact("gaps", format!("{}, the longest of {longest:.4} s before line {at}", counted(gaps, "gap")));
    }
    if let Some((line, value)) = late_at {
        let value = format!("{value} in the first of {}", counted(late, "row"));
        file.fault(line, name.clone(), value, "a time later than that of the row before");
    }
}

/// How many rows repeat the one before, time aside, and the line of the first.
fn repeated(table: &Table, guess: &TableGuess) -> (usize, Option<u64>) {
    let counts =
        |quantity: Option<Quantity>| matches!(quantity, Some(Quantity::Time | Quantity::Other | Quantity::Frame));
    let columns: Vec<usize> =
        guess.columns.iter().filter(|c| !counts(c.quantity) && !c.values.is_constant()).map(|c| c.column).collect();
    let (mut found, mut first) = (0, None);
    let mut before: Option<Row<'_>> = None;
    for row in table.rows() {
        let is_same = |before: Row<'_>| columns.iter().all(|column| before.cell(*column) == row.cell(*column));
        if !columns.is_empty() && before.is_some_and(is_same) {
            found += 1;
            first = first.or(Some(row.line()));
        }
        before = Some(row);
    }
    (found, first)
}

fn cells(file: &mut InspectedFile, table: &Table, guess: &TableGuess) {
    let wrong: Vec<_> = table.faults().collect();
    if let Some(first) = wrong.first() {
        let (value, expected) = match first.problem {
            RowProblem::Cells { found, expected, .. } => (counted(found, "cell"), counted(expected, "cell")),
            ref other => (other.to_string(), "numbers".to_owned()),
        };
        let value = format!("{value} in the first of {}", counted(wrong.len(), "row"));
        file.fault(first.line, "row", value, expected);
    }
    for column in guess.columns.iter().filter(|column| column.role.is_some_and(|role| role.dimension().is_some())) {
        let name = &table.columns()[column.column].name;
        let values = &column.values;
        if let Some(line) = values.first_text {
            let text = table.rows().find(|row| row.line() == line).map(|row| match row.cell(column.column) {
                Cell::Text(text) => text.chars().take(24).collect::<String>(),
                _ => String::new(),
            });
            let value = format!("`{}`, the first of {}", text.unwrap_or_default(), counted(values.texts, "cell"));
            file.fault(line, name.clone(), value, "a number");
        }
        if values.not_finite > 0 {
            file.fault(None, name.clone(), counted(values.not_finite, "number") + " not finite", "finite numbers");
        }
        let empty = values.empty.saturating_sub(wrong.len());
        if empty > 0 {
            file.fault(None, name.clone(), counted(empty, "empty cell"), "a number in each row");
        }
    }
}
