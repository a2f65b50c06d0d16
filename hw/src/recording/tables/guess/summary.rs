//! A summary of the values of a column.

use super::super::table::{Cell, Table};

/// A summary of the values of a column, in the unit of the column.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColumnSummary {
    /// How many finite numbers there are.
    pub numbers: usize,
    /// How many cells are empty.
    pub empty: usize,
    /// How many hold something else.
    pub texts: usize,
    /// Line of the first that does.
    pub first_text: Option<u64>,
    /// How many numbers are not finite.
    pub not_finite: usize,
    /// The least number; 0 without any.
    pub least: f64,
    /// The largest number; 0 without any.
    pub most: f64,
    /// How many numbers are larger than the number before.
    pub rises: usize,
    /// How many are smaller.
    pub falls: usize,
    /// How many are the same.
    pub repeats: usize,
    /// Median of the sizes of the steps that are not 0; 0 without any.
    pub step: f64,
    /// The largest step.
    pub longest_step: f64,
    /// Line of the row behind the largest step.
    pub after_longest: u64,
    /// Whether all numbers are whole.
    pub whole: bool,
}

impl ColumnSummary {
    /// Of a column, from 0.
    pub fn of(table: &Table, column: usize) -> Self {
        let mut found = Self { whole: true, ..Self::default() };
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut last, mut steps) = (None, Vec::new());
        for row in table.rows() {
            match row.cell(column) {
                Cell::Number(value) if value.is_finite() => {
                    found.numbers += 1;
                    (least, most) = (least.min(value), most.max(value));
                    found.whole &= value.fract() == 0.0;
                    let Some(before) = last.replace(value) else { continue };
                    let step: f64 = value - before;
                    match step {
                        step if step > 0.0 => found.rises += 1,
                        step if step < 0.0 => found.falls += 1,
                        _ => found.repeats += 1,
                    }
                    if step != 0.0 {
                        steps.push(step.abs());
                    }
                    if step.abs() > found.longest_step {
                        (found.longest_step, found.after_longest) = (step.abs(), row.line());
                    }
                }
                Cell::Number(_) => found.not_finite += 1,
                Cell::Empty => found.empty += 1,
                Cell::Text(_) => {
                    found.texts += 1;
                    found.first_text = found.first_text.or(Some(row.line()));
                }
            }
        }
        if found.numbers > 0 {
            (found.least, found.most) = (least, most);
        }
        found.whole &= found.numbers > 0;
        steps.sort_unstable_by(f64::total_cmp);
        found.step = steps.get(steps.len() / 2).copied().unwrap_or_default();
        found
    }

    /// Largest value less the least one.
    pub fn range(&self) -> f64 {
        self.most - self.least
    }

    /// The largest size.
    pub fn size(&self) -> f64 {
        self.most.abs().max(self.least.abs())
    }

    /// Whether all numbers are the same.
    pub fn is_constant(&self) -> bool {
        self.numbers > 0 && self.rises == 0 && self.falls == 0
    }

    /// Whether the numbers grow as times do: hardly any step back, hardly any repeated.
    pub fn is_growing(&self) -> bool {
        self.numbers > 2 && 50 * (self.falls + self.repeats) <= self.numbers
    }
}
