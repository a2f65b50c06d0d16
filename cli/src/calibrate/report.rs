//! A calibration in words.

use super::result::RodCalibration;
use rod_files::confounders_text;
use rod_files::table::Table;
use std::fmt::Write;
use vibrissa::reconstruct::{Source, SourceEstimate};

/// Part of its budget below which an estimate is told as 0.
const NOTHING: f64 = 1e-9;
/// Most sources that are told where recordings contradict each other.
const MOST: usize = 5;

impl RodCalibration {
    /// The sources with budget, estimate and standard deviation, the pairs that are not separated, and the calibrated rod.
    pub fn report(&self) -> String {
        let mut text = String::new();
        let count = self.recordings.len();
        let _ = writeln!(text, "{count} recording{}", if count == 1 { "" } else { "s" });
        if self.combined.contradicts() {
            return text + &self.differences();
        }
        let mut table = Table::new(["source", "unit", "known", "budget", "estimate", "sigma", "written", "identified"]);
        for (name, estimate) in self.named().filter(|(_, estimate)| estimate.budget > 0.0) {
            let unit = estimate.source.name().1;
            let numbers = [estimate.known, estimate.given, estimate.value, estimate.sigma];
            let number = |value: f64| {
                if value.abs() < NOTHING * estimate.budget { "0".to_owned() } else { format!("{value:.3e}") }
            };
            let identified = if estimate.is_identified() { "yes" } else { "no" };
            let raised = if estimate.raised { ", budget raised" } else { "" };
            let cells = [name, if unit.is_empty() { "1" } else { unit }.to_owned()];
            // friction is of the objects, not of the rod
            let written = if estimate.source.is_of_scan() { "-".to_owned() } else { number(estimate.taken) };
            table.row(cells.into_iter().chain(numbers.map(number)).chain([written, format!("{identified}{raised}")]));
        }
        text += &table.to_string();
        let mut ties: Vec<String> = self.combined.ties.iter().map(|(a, b, _)| format!("{a} and {b}")).collect();
        ties.dedup();
        if !ties.is_empty() {
            let _ = writeln!(text, "not separated: {}", ties.join("; "));
        }
        for (number, (name, estimate)) in self.named().enumerate() {
            let others = confounders_text(estimate.value, estimate.sigma, &self.combined.confounders(number));
            if estimate.source == Source::Friction && !others.is_empty() {
                let _ = writeln!(text, "{name}: mu = {:.4} +- {:.1e}{others}", estimate.value, estimate.sigma);
            }
        }
        if self.combined.freedom > 0 {
            let (chi_squared, freedom) = (self.combined.chi_squared, self.combined.freedom);
            let _ = writeln!(
                text,
                "differences of the recordings: chi-squared {chi_squared:.1} with {freedom} degrees of freedom; they agree"
            );
        }
        let [given, found] = [&self.given, &self.rod].map(|rod| (1e3 * rod.length(), rod.bending_stiffness()));
        let _ = writeln!(
            text,
            "rod: length {:.4} mm, bending stiffness {:.5e} N m^2; given {:.4} mm, {:.5e} N m^2",
            found.0, found.1, given.0, given.1
        );
        text
    }

    /// The sources with their names; friction has that of its recording.
    fn named(&self) -> impl Iterator<Item = (String, &SourceEstimate)> {
        let mut recordings: Vec<usize> = self.each.iter().map(|one| one.0).collect();
        recordings.dedup();
        let mut files = recordings.into_iter().filter_map(|number| self.recordings[number].file_name());
        self.combined.sources.iter().map(move |estimate| {
            let name = estimate.source.to_string();
            let of = if estimate.source == Source::Friction { files.next() } else { None };
            (of.map_or(name.clone(), |file| format!("{name} of {}", file.to_string_lossy())), estimate)
        })
    }

    /// What each pass says on its own of the sources that differ most.
    fn differences(&self) -> String {
        let mut text = String::from(
            "the recordings contradict each other; the estimates of each recording, largest differences first:\n",
        );
        let apart = |source: Source| {
            let all: Vec<_> = self.each.iter().filter_map(|(_, one)| one.source(source)).collect();
            let pairs = all.iter().enumerate().flat_map(|(k, a)| all[k + 1..].iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| (a.value - b.value).abs() / a.sigma.hypot(b.sigma)).fold(0.0, f64::max)
        };
        let mut sources: Vec<(Source, f64)> =
            Source::ALL.into_iter().filter(|source| !source.is_of_scan()).map(|s| (s, apart(s))).collect();
        sources.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut table = Table::new(["recording", "source", "unit", "estimate", "sigma"]);
        for (source, _) in sources.into_iter().take(MOST) {
            let (name, unit) = source.name();
            for (number, one) in &self.each {
                let Some(found) = one.source(source) else { continue };
                let file = self.recordings[*number].file_name().unwrap_or_default().to_string_lossy().into_owned();
                let unit = if unit.is_empty() { "1" } else { unit };
                table.row([
                    file,
                    name.to_owned(),
                    unit.to_owned(),
                    format!("{:.3e}", found.value),
                    format!("{:.1e}", found.sigma),
                ]);
            }
        }
        text += &table.to_string();
        text
    }
}
