//! What an error costs.

use crate::row::Row;

/// Times nearer to each other than this part of them are the same.
const SAME: f64 = 0.05;

/// The cheapest row with no larger error, of rows of one task and problem: the first of those as cheap.
pub fn cheapest<'a>(rows: impl Iterator<Item = &'a Row> + Clone, error: f64) -> Option<(&'a Row, f64)> {
    let good = rows.filter(|row| row.error.is_some_and(|of_row| of_row <= error));
    let mut good = good.filter_map(|row| Some((row, row.seconds?)));
    let least = good.clone().map(|(_, time)| time).min_by(f64::total_cmp)?;
    good.find(|(_, time)| *time <= (1.0 + SAME) * least)
}

/// The time a method needs for an error: of its cheapest setting that is good enough, or less, where a setting between two of
/// those measured would do (log-log).
pub fn time_at<'a>(rows: impl Iterator<Item = &'a Row> + Clone, error: f64) -> Option<f64> {
    let found: Vec<(f64, f64)> =
        rows.clone().filter_map(|row| Some((row.error?.max(f64::MIN_POSITIVE).ln(), row.seconds?.ln()))).collect();
    let at = error.ln();
    let between = found.windows(2).filter_map(|pair| {
        let [(e0, t0), (e1, t1)] = [pair[0], pair[1]];
        let part = (at - e0) / (e1 - e0);
        (0.0..=1.0).contains(&part).then(|| (t0 + part * (t1 - t0)).exp())
    });
    cheapest(rows, error).map(|(_, time)| time).into_iter().chain(between).min_by(f64::total_cmp)
}

/// A time as people read it.
pub fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (1e6 * s, "us"),
        s if s < 1.0 => (1e3 * s, "ms"),
        s => (s, "s"),
    };
    let digits = (1 - value.log10().floor() as i32).max(0) as usize;
    format!("{value:.digits$} {unit}")
}
