//! Derivatives of an exact solution by differences in double-double, against sensitivities.

use super::judge::{Exact, exact_cut};
use rod_core::{Cut, CutSensitivities};
use twofloat::TwoFloat;

/// Step of the central differences: their error is its square, what the judge errs by, 1e-24, counts over it.
const STEP: f64 = 1e-8;

/// An interval of a rod and its load.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub s: f64,
    pub start: Cut,
    pub a: f64,
    pub b: f64,
    pub length: f64,
}

/// An exact solution: arc length at the start, cut there, force, arc length at the end.
pub trait Solution: Fn(TwoFloat, Exact, [TwoFloat; 2], TwoFloat) -> Exact {}
impl<F: Fn(TwoFloat, Exact, [TwoFloat; 2], TwoFloat) -> Exact> Solution for F {}

pub fn end(solution: &impl Solution, &Interval { s, start, a, b, length }: &Interval) -> Exact {
    let two = TwoFloat::from;
    solution(two(s), exact_cut(&start), [a, b].map(two), two(s) + two(length))
}

/// The largest difference of the sensitivities to those of the exact solution, relative to 1 + |value|.
pub fn error_of_sensitivities(solution: &impl Solution, interval: &Interval, ours: &CutSensitivities) -> f64 {
    let &Interval { s, start, a, b, length } = interval;
    let two = TwoFloat::from;
    let moved = |variable: usize, by: f64| {
        let shift = |i: usize| two(if i == variable { by } else { 0.0 });
        let [x, y, phi, moment] = exact_cut(&start);
        let from = two(s) + shift(4);
        let to = two(s) + two(length) + shift(5);
        solution(from, [x, y, phi + shift(0), moment + shift(1)], [two(a) + shift(2), two(b) + shift(3)], to)
    };
    let CutSensitivities { by_phi, by_moment, by_a, by_b, by_from, by_to } = *ours;
    let mut worst: f64 = 0.0;
    for (variable, column) in [by_phi, by_moment, by_a, by_b, by_from, by_to].into_iter().enumerate() {
        let (up, down) = (moved(variable, STEP), moved(variable, -STEP));
        for (i, ours) in column.into_iter().enumerate() {
            let exact = f64::from((up[i] - down[i]) / (2.0 * STEP));
            let error = (ours - exact).abs() / (1.0 + exact.abs());
            worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
        }
    }
    worst
}

/// Median, 99th percentile and worst of many errors.
pub fn spread(mut errors: Vec<f64>) -> [f64; 3] {
    errors.sort_by(f64::total_cmp);
    let n = errors.len();
    [errors[n / 2], errors[n - 1 - n / 100], errors[n - 1]]
}
