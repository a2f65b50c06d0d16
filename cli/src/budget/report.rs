//! What to expect, in words.

use super::needed::{Factor, TARGET};
use super::study::Expected;
use super::trials::Trial;
use rod_files::table::Table;
use std::fmt::Write;

/// Share of right labels below which the derivatives say nothing of a recording.
const RIGHT: f64 = 0.95;
/// How many errors are named that a better sensor does not help against.
const LARGEST: usize = 3;

impl Expected {
    /// The sources of error, what sensor would be needed, and how recordings with random errors were reconstructed.
    pub fn report(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.tell(&mut text);
        text
    }

    fn tell(&self, text: &mut String) -> std::fmt::Result {
        let forecast = &self.forecast;
        writeln!(
            text,
            "{}: {} samples, noise {:.2e} N, {:.2e} N, {:.2e} N m",
            self.scene.name, self.samples, self.sigma.f0x, self.sigma.f0y, self.sigma.m0z
        )?;
        writeln!(text, "standard deviation across the contour of single contacts, median, and by each error alone:")?;
        let mut table = Table::new(["error", "unit", "budget", "left", "before mm", "after mm"]);
        let mm = |metres: f64| format!("{:.2e}", 1e3 * metres);
        for share in &forecast.sources {
            let (name, unit) = share.source.name();
            let ([budget, left], [before, after]) = (share.sigma, share.displacement);
            let unit = if unit.is_empty() { "1" } else { unit };
            let numbers = [format!("{budget:.2e}"), format!("{left:.2e}"), mm(before), mm(after)];
            table.row([name.to_owned(), unit.to_owned()].into_iter().chain(numbers));
        }
        let [before, after] = forecast.shared;
        let row = |name: &str, before: f64, after: f64| {
            [name.to_owned(), "-".into(), "-".into(), "-".into(), mm(before), mm(after)]
        };
        table.row(row("all systematic errors", before, after));
        table.row(row("noise", forecast.noise, forecast.noise));
        table.row(row("all", before.hypot(forecast.noise), forecast.total()));
        write!(text, "{table}")?;
        if let Some(known) = forecast.with_known_friction {
            writeln!(
                text,
                "with an exactly known coefficient of friction, the systematic errors after calibration would be {} mm instead of \
                 {} mm",
                mm(known),
                mm(after)
            )?;
        }
        self.tell_needed(text)?;
        self.tell_runs(text)
    }

    fn tell_needed(&self, text: &mut String) -> std::fmt::Result {
        let Some(needed) = &self.needed else { return Ok(()) };
        let target = 1e3 * TARGET;
        match needed.sensor {
            Factor::Is(factor) => {
                writeln!(
                    text,
                    "{target} mm after calibration need {factor:.2} times the noise, bias and drift of the sensor"
                )?;
            }
            Factor::NotEnough(_) => {
                let names: Vec<String> =
                    self.forecast.largest(LARGEST).iter().map(|share| share.source.to_string()).collect();
                writeln!(
                    text,
                    "{target} mm need more than a better sensor: other errors remain, most of all {}; reduce them, state \
                     them more exactly, or calibrate with several recordings",
                    names.join(", ")
                )?;
            }
            Factor::Always(factor) => {
                writeln!(
                    text,
                    "{target} mm are reached with up to {factor} times the noise, bias and drift of the sensor, and more"
                )?;
            }
        }
        match needed.stiffness {
            Factor::Is(factor) => writeln!(text, "or {factor:.2} times the stiffness of the rod, with the same sensor"),
            _ => Ok(()),
        }
    }

    fn tell_runs(&self, text: &mut String) -> std::fmt::Result {
        if self.runs.is_empty() {
            return Ok(());
        }
        writeln!(text, "{} recordings with random errors, reconstructed:", self.runs.len())?;
        let mut table = Table::new([
            "",
            "labels right %",
            "median mm",
            "95 % mm",
            "stated sigma mm",
            "beyond 6 sigma %",
            "(d/sigma)^2",
        ]);
        let columns: [&dyn Fn(&Trial) -> f64; 6] = [
            &|run| 100.0 * run.labels_right,
            &|run| 1e3 * run.median.unwrap_or(f64::NAN),
            &|run| 1e3 * run.percentile_95.unwrap_or(f64::NAN),
            &|run| 1e3 * run.stated.unwrap_or(f64::NAN),
            &|run| 100.0 * run.beyond_six_sigma,
            &|run| run.error_variance.unwrap_or(f64::NAN),
        ];
        let sorted = columns.map(|column| {
            let mut values: Vec<f64> = self.runs.iter().map(column).filter(|value| value.is_finite()).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        });
        let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"));
        for (name, share) in [("least", 0.0), ("median", 0.5), ("largest", 1.0)] {
            let of = |values: &Vec<f64>| {
                cell(values.get((share * values.len().saturating_sub(1) as f64).round() as usize).copied())
            };
            table.row([name.to_owned()].into_iter().chain(sorted.iter().map(of)));
        }
        let mean =
            |values: &Vec<f64>| cell((!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64));
        table.row(["mean".to_owned()].into_iter().chain(sorted.iter().map(mean)));
        write!(text, "{table}")?;
        let wrong = self.runs.iter().filter(|run| run.labels_right < RIGHT).count();
        if wrong > 0 {
            writeln!(
                text,
                "in {wrong} of them fewer than {:.0} % of the labels are right: the forecast does not hold for these errors",
                100.0 * RIGHT
            )?;
        }
        Ok(())
    }
}
