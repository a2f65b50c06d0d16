//! A calibration in words.

use super::result::RodCalibration;
use crate::table::Table;
use std::fmt::Write;

/// Part of its budget below which an estimate is told as 0.
const NOTHING: f64 = 1e-9;

impl RodCalibration {
    /// The sources with budget, estimate and standard deviation, what is not told apart, and the rod as it was found.
    pub fn report(&self) -> String {
        let mut text = String::new();
        let count = self.recordings.len();
        let _ = writeln!(text, "{count} recording{}", if count == 1 { "" } else { "s" });
        let mut table = Table::new(["source", "unit", "known", "budget", "estimate", "sigma", "written", "identified"]);
        for estimate in self.combined.sources.iter().filter(|estimate| estimate.budget > 0.0) {
            let (name, unit) = estimate.source.name();
            let numbers = [estimate.known, estimate.given, estimate.value, estimate.sigma, estimate.taken];
            let number = |value: f64| {
                if value.abs() < NOTHING * estimate.budget { "0".to_owned() } else { format!("{value:.3e}") }
            };
            let identified = if estimate.is_identified() { "yes" } else { "no" };
            let raised = if estimate.raised { ", budget raised" } else { "" };
            let cells = [name.to_owned(), if unit.is_empty() { "1" } else { unit }.to_owned()];
            table.row(cells.into_iter().chain(numbers.map(number)).chain([format!("{identified}{raised}")]));
        }
        text += &table.to_string();
        let ties: Vec<String> = self.combined.ties.iter().map(|(a, b, _)| format!("{a} and {b}")).collect();
        if !ties.is_empty() {
            let _ = writeln!(text, "not told apart: {}", ties.join("; "));
        }
        if self.combined.freedom > 0 {
            let (chi_squared, freedom) = (self.combined.chi_squared, self.combined.freedom);
            let verdict = if self.combined.contradicts() { "they contradict each other" } else { "they agree" };
            let _ = writeln!(
                text,
                "differences of the recordings: chi-squared {chi_squared:.1} with {freedom} degrees of freedom; {verdict}"
            );
        }
        if self.combined.contradicts() {
            return text;
        }
        let [given, found] = [&self.given, &self.rod].map(|rod| (1e3 * rod.length(), rod.bending_stiffness()));
        let _ = writeln!(
            text,
            "rod: length {:.4} mm, bending stiffness {:.5e} N m^2; given {:.4} mm, {:.5e} N m^2",
            found.0, found.1, given.0, given.1
        );
        text
    }
}
