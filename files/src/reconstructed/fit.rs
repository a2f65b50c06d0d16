//! The fit of one contour to the whole recording: its record in report.json, and what it says.

use super::result::Reconstructed;
use serde::Serialize;
use std::fmt::Write;
use vibrissa::Label;
use vibrissa::reconstruct::{ContourFit, FitError, Source};

impl Reconstructed {
    /// Adds whether one contour explains the recording; nothing where that was not looked at.
    pub(super) fn tell_fit(&self, text: &mut String) -> std::fmt::Result {
        let Some(Ok(fit)) = &self.fit else { return Ok(()) };
        let goodness = &fit.goodness;
        let labels = FitRecord::of(&Ok(fit.clone()), &self.rows).runs;
        let labels: Vec<String> = labels.iter().filter_map(|run| run.label).map(|label| label.to_string()).collect();
        writeln!(
            text,
            "fit: {} the recording, chi squared {:.0} of {:.0} degrees of freedom; phases: {}",
            if goodness.explains { "one contour explains" } else { "no contour explains" },
            goodness.chi_squared,
            goodness.degrees_of_freedom,
            labels.join(" ")
        )
    }

    /// Why one contour does not explain the recording; none where it does, or where that was not looked at.
    pub fn contradiction(&self) -> Option<String> {
        let fit = match self.fit.as_ref()? {
            Ok(fit) if fit.goodness.explains => return None,
            Ok(fit) => fit,
            Err(error) => return Some(format!("whether one contour explains the recording is not known: {error}")),
        };
        let mut why = "no contour was found that explains the whole recording".to_owned();
        if let Some(worst) = fit.goodness.worst.as_ref().filter(|worst| worst.p_value < 1e-4) {
            let (from, to) = (self.rows[worst.samples.start], self.rows[worst.samples.end - 1]);
            why += &format!("; it fails worst in {} at rows {from} to {to}", worst.channel);
        }
        let missing = FitRecord::of(&Ok(fit.clone()), &self.rows).runs;
        let missing = missing.iter().filter(|run| run.label.is_none());
        if let Some(longest) = missing.max_by_key(|run| run.to - run.from).filter(|_| fit.goodness.unreached > 0.02) {
            why += &format!(
                "; at {:.0} % of the samples, as rows {} to {}, the rod cannot be on it",
                100.0 * fit.goodness.unreached,
                longest.from,
                longest.to
            );
        }
        if let Some((source, off)) = fit.goodness.farthest_error.filter(|error| error.1.abs() > 5.0) {
            why += &format!("; its {source} is {off:.0} standard deviations off what is known");
        }
        Some(
            why + ": the points there may be wrong, the object, the rod or the sensor changed, or the fit had no good start; compare the \
                   labels in phases.svg with `fit.runs` in report.json",
        )
    }
}

/// The fit of one contour to the whole recording.
#[derive(Default, Serialize)]
pub(super) struct FitRecord {
    /// Whether the contour explains the recording; false where there is no fit.
    explains: bool,
    /// Why there is no fit.
    missing: Option<String>,
    chi_squared: Option<f64>,
    degrees_of_freedom: Option<f64>,
    p_value: Option<f64>,
    /// Share of the blocks of samples at whose poses the model has no state.
    unreached: Option<f64>,
    /// The error that is farthest off what is known of it.
    farthest_error: Option<FarthestErrorRecord>,
    worst: Option<WorstRecord>,
    runs: Vec<FittedRunRecord>,
    errors: Vec<FittedErrorRecord>,
}

/// The place at which the fit explains the recording worst.
#[derive(Serialize)]
struct WorstRecord {
    /// First and last row.
    rows: [usize; 2],
    channel: String,
    chi_squared: f64,
    residuals: usize,
    p_value: f64,
}

/// How far an error is off what is known of it, in standard deviations of its budget.
#[derive(Serialize)]
struct FarthestErrorRecord {
    source: Source,
    standard_deviations: f64,
}

/// Rows along which the model has one phase; null where it has no state.
#[derive(Serialize)]
struct FittedRunRecord {
    label: Option<Label>,
    from: usize,
    to: usize,
}

#[derive(Serialize)]
struct FittedErrorRecord {
    source: Source,
    value: f64,
    sigma: f64,
}

impl FitRecord {
    pub fn of(fit: &Result<ContourFit, FitError>, rows: &[usize]) -> Self {
        let fit = match fit {
            Ok(fit) => fit,
            Err(error) => return Self { missing: Some(error.to_string()), ..Self::default() },
        };
        let goodness = &fit.goodness;
        let mut runs: Vec<FittedRunRecord> = Vec::new();
        for block in &fit.blocks {
            let (from, to) = (rows[block.samples.start], rows[block.samples.end - 1]);
            match runs.last_mut().filter(|run| run.label == block.label) {
                Some(run) => run.to = to,
                None => runs.push(FittedRunRecord { label: block.label, from, to }),
            }
        }
        Self {
            explains: goodness.explains,
            missing: None,
            chi_squared: Some(goodness.chi_squared),
            degrees_of_freedom: Some(goodness.degrees_of_freedom),
            p_value: Some(goodness.p_value),
            unreached: Some(goodness.unreached),
            farthest_error: goodness
                .farthest_error
                .map(|(source, off)| FarthestErrorRecord { source, standard_deviations: off }),
            worst: goodness.worst.as_ref().map(|worst| WorstRecord {
                rows: [rows[worst.samples.start], rows[worst.samples.end - 1]],
                channel: worst.channel.clone(),
                chi_squared: worst.chi_squared,
                residuals: worst.residuals,
                p_value: worst.p_value,
            }),
            runs,
            errors: fit
                .errors
                .iter()
                .map(|&(source, value, sigma)| FittedErrorRecord { source, value, sigma })
                .collect(),
        }
    }
}
