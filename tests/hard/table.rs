//! A case taken towards its cliff: what is printed, and what must hold of it.

use super::exact::Problem;
use super::measure::{Measure, solved};

/// Forward error against condition times 2.2e-16 that a solution may have.
pub const MOST: f64 = 10.0;

/// Tolerance of the solves: all that rounding leaves is wanted.
const TIGHT: f64 = 1e-15;

/// Powers of ten from 10^first down to 10^last.
pub fn powers(first: i32, last: i32) -> impl Iterator<Item = f64> {
    (last..=first).rev().map(|n| 10.0_f64.powi(n))
}

/// Solves the problems made for `values` from unknowns off by `off`, prints what came out, and asserts that what is called
/// solved is as exact as its condition allows.
pub fn towards(
    case: &str,
    values: impl Iterator<Item = f64>,
    make: impl Fn(f64) -> (Problem, Vec<f64>),
    off: impl Fn(f64) -> f64,
) -> Vec<(f64, Measure)> {
    let rows: Vec<_> = values
        .map(|value| {
            let (problem, mut u) = make(value);
            for (i, u) in u.iter_mut().enumerate() {
                *u += off(value) * [1.0, -0.7, 0.4][i % 3];
            }
            (value, solved(&problem, &mut u, TIGHT))
        })
        .collect();
    for (value, measure) in &rows {
        show(case, *value, measure);
    }
    for (value, measure) in &rows {
        check(case, *value, measure);
    }
    summary(case, &rows);
    rows
}

/// A line of the table.
pub fn show(case: &str, value: f64, measure: &Measure) {
    println!("{case:<34} {value:8.0e}  {measure}");
}

/// What is called solved is as exact as its condition allows.
pub fn check(case: &str, value: f64, measure: &Measure) {
    assert!(!measure.status.is_solved() || measure.factor() <= MOST, "{case} at {value:e}: {measure}");
}

/// The largest of each column over what was solved, as a row of the page.
pub fn summary(case: &str, rows: &[(f64, Measure)]) {
    let solved: Vec<_> = rows.iter().filter(|(_, m)| m.status.is_solved()).collect();
    let most = |f: fn(&Measure) -> f64| solved.iter().map(|(_, m)| f(m)).fold(0.0, f64::max);
    let range = match (solved.first(), solved.last()) {
        (Some((first, _)), Some((last, _))) => format!("{first:.0e} to {last:.0e}"),
        _ => "none".into(),
    };
    println!(
        "| {case} | {range} | {:.1e} | {:.1e} | {:.1e} |",
        most(|m| m.forward),
        most(|m| m.backward),
        most(|m| m.condition)
    );
}
