//! Times and rows of a table: rate, gaps, repeated rows, cells that are no numbers.

use super::report::InspectedFile;
use super::values::factor;
use crate::table::counted;
use vibrissa::hw::recording::{Cell, Quantity, Role, Row, RowProblem, Table, TableGuess, TableKind};

/// Steps of the time beyond this many usual ones are gaps.
const GAP: f64 = 1.5;

/// With more than one step of time in so many against the others the rows are in no order.
const SHUFFLED: usize = 50;
/// So many rows one after the other, earlier than one before them and growing, have the times of a clock that began anew.
const ANEW: usize = 8;
/// A mark of missing values is so many ranges of the other values away from them.
const AWAY: f64 = 3.0;
/// Rows in which a reading stays the same, or at its limit, at least: relative to all rows, and as a number.
const STUCK: (usize, usize) = (50, 8);

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
    values(file, table, guess);
}

/// Names values that are no measurements: marks of missing ones, those of a stuck or clipped sensor.
fn values(file: &mut InspectedFile, table: &Table, guess: &TableGuess) {
    let loads = |quantity| matches!(quantity, Some(Quantity::Force | Quantity::Torque | Quantity::Raw));
    for column in guess.columns.iter().filter(|column| loads(column.quantity) && !column.values.is_constant()) {
        let name = &table.columns()[column.column].name;
        let all: Vec<(u64, f64)> = table
            .rows()
            .filter_map(|row| Some((row.line(), row.number(column.column).ok()?)))
            .filter(|(_, value)| value.is_finite())
            .collect();
        if let Some((mark, count, line)) = mark(&all) {
            let value = format!("{mark} in {}, far from all others", counted(count, "row"));
            file.fault(line, name.clone(), value, "an empty cell or NaN where there is no measurement");
        }
        let enough = (all.len() / STUCK.0).max(STUCK.1);
        let limits = [column.values.least, column.values.most];
        let at = limits.map(|limit| all.iter().filter(|(_, value)| *value == limit).count());
        let is_clipped = |k: usize| limits[k] != 0.0 && at[k] >= enough;
        if let Some(k) = [0, 1].into_iter().find(|k| is_clipped(*k)) {
            let value = format!("exactly {}, its limit, in {}", limits[k], counted(at[k], "row"));
            file.fault(
                all.iter().find(|one| one.1 == limits[k]).map(|one| one.0),
                name.clone(),
                value,
                "no clipped values",
            );
        }
        let runs = all.chunk_by(|a, b| a.1 == b.1).filter(|run| run[0].1 != 0.0 && !limits.contains(&run[0].1));
        if let Some(run) = runs.max_by_key(|run| run.len()).filter(|run| run.len() >= enough) {
            let value = format!("{} in {} one after the other", run[0].1, counted(run.len(), "row"));
            file.fault(run[0].0, name.clone(), value, "values that change: a sensor that is not stuck");
        }
    }
}

/// A value that is far from all others, in how many rows, and the line of the first.
fn mark(all: &[(u64, f64)]) -> Option<(f64, usize, u64)> {
    let mut sorted: Vec<f64> = all.iter().map(|one| one.1).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (least, most) = (*sorted.first()?, *sorted.last()?);
    [least, most].into_iter().find_map(|mark| {
        let others = || sorted.iter().copied().filter(|value| *value != mark);
        let (low, high) = others().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let count = sorted.len() - others().count();
        let gap = (low - mark).max(mark - high);
        let line = all.iter().find(|one| one.1 == mark)?.0;
        (count > 1 && 2 * count < sorted.len() && gap > AWAY * (high - low)).then_some((mark, count, line))
    })
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
    let (mut last, mut latest): (Option<f64>, f64) = (None, f64::NEG_INFINITY);
    // rows one after the other that are earlier than one before them, and grow
    let (mut anew, mut most_anew) = (0, 0);
    for row in table.rows() {
        let Cell::Number(value) = row.cell(column.column) else { continue };
        let time = factor * value;
        if let Some(before) = last {
            anew = if time <= latest { anew + usize::from(time > before) } else { 0 };
            most_anew = most_anew.max(anew);
            if time <= latest {
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
        latest = latest.max(time);
    }
    if gaps > 0 {
        file.fact("gaps", format!("{}, the longest of {longest:.4} s before line {at}", counted(gaps, "gap")));
    }
    if let Some((line, value)) = late_at {
        let value = format!("{value} in the first of {}", counted(late, "row"));
        let is_sensor = matches!(guess.kind, TableKind::Wrench | TableKind::Raw | TableKind::Stage);
        if most_anew >= ANEW && is_sensor {
            let expected = "one clock: the rows from this line on have other times; save them in a file of their own";
            file.prevents(line, name.clone(), value, expected);
        } else if SHUFFLED * column.values.rises.min(column.values.falls) > column.values.numbers {
            file.prevents(line, name.clone(), value, "rows in the order of time: sort them");
        } else {
            file.fault(line, name.clone(), value, "a time later than that of the row before");
        }
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
