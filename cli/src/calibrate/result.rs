//! What the recordings tell.

use super::freed::{Freed, known_besides, with_held};
use crate::figure::Residual;
use rod_files::{Reconstructed, ReconstructionError, Recording};
use std::path::PathBuf;
use vibrissa::reconstruct::{Budget, Calibration, Combined, Known};
use vibrissa::{Rod, Settings};

/// Why recordings tell nothing of the rod.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// No source has a budget.
    #[error(
        "nothing to calibrate: the budget of every requested source is 0; change the table [errors] of --setup, or --free"
    )]
    Nothing,
    /// A recording cannot be reconstructed.
    #[error(transparent)]
    Reconstruction(#[from] ReconstructionError),
}

/// What recordings of one rod tell of rod, sensor, clamp and stage.
#[derive(Debug)]
pub struct RodCalibration {
    /// The recordings.
    pub recordings: Vec<PathBuf>,
    /// The rod as it was given.
    pub given: Rod,
    /// The rod as it was found.
    pub rod: Rod,
    /// What is known of the errors, relative to the rod as it was found.
    pub known: Known,
    /// The estimates, relative to the rod as it was given.
    pub combined: Combined,
    /// Those of each pass of each recording, with the number of the recording.
    pub each: Vec<(usize, Calibration)>,
    /// What does not fit, in words.
    pub findings: Vec<String>,
    /// How far the criteria are from 0 with recordings and rod as they are, and after the calibration.
    pub(crate) residuals: [Vec<Residual>; 2],
}

impl RodCalibration {
    /// From recordings of the rod. Only the errors that `free` names are looked for, all where it is empty; bias and drift are taken off
    /// each recording.
    ///
    /// # Errors
    /// [`CalibrateError`].
    pub fn new(
        recordings: &[Recording],
        rod: Rod,
        given: Known,
        settings: &Settings,
        free: &[Freed],
    ) -> Result<Self, CalibrateError> {
        let budget = settings.budget.unwrap_or_else(|| Budget::laboratory(&rod));
        let known = if free.is_empty() { given } else { known_besides(&given, &budget, free) };
        let (mut each, mut findings) = (Vec::<(usize, Calibration)>::new(), Vec::new());
        for (number, recording) in recordings.iter().enumerate() {
            let settings = Settings { known, ..*settings };
            let found = Reconstructed::new(recording.clone(), rod, &settings)?;
            each.extend(found.found.passes.iter().filter_map(|pass| Some((number, pass.calibration.clone()?))));
            let misfits = found.check.findings.iter().filter(|finding| finding.is_misfit());
            findings.extend(misfits.map(|finding| format!("{}: {finding}", recording.file.display())));
        }
        let combined = Combined::of(&each).ok_or(CalibrateError::Nothing)?;
        findings.extend(contradictions(&combined));
        let (found, known) = combined.known(&rod);
        let known = with_held(known, &given, free);
        let after = Settings { known, ..*settings };
        let before = Settings { budget: Some(Budget::NONE), known: Known::NOTHING, ..*settings };
        let mut residuals = [Vec::new(), Vec::new()];
        for recording in recordings {
            let before = Reconstructed::new(recording.clone(), rod, &before)?;
            let after = Reconstructed::new(recording.clone(), found, &after)?;
            residuals[0].extend(Residual::all(&before, &after));
            residuals[1].extend(Residual::all(&after, &after));
        }
        let files = recordings.iter().map(|recording| recording.file.clone()).collect();
        Ok(Self { recordings: files, given: rod, rod: found, known, combined, each, findings, residuals })
    }
}

/// Recordings that contradict each other, and estimates beyond their budgets.
fn contradictions(combined: &Combined) -> Vec<String> {
    let mut found = Vec::new();
    if combined.contradicts() {
        let Combined { chi_squared, freedom, .. } = combined;
        found.push(format!(
            "the recordings contradict each other: chi-squared of their estimates is {chi_squared:.0} with {freedom} degrees of \
             freedom; was the rod clamped anew, or the sensor changed between them?"
        ));
        // what is estimated of them together means nothing
        return found;
    }
    for estimate in combined.sources.iter().filter(|estimate| estimate.is_beyond()) {
        let (name, unit) = estimate.source.name();
        let space = if unit.is_empty() { "" } else { " " };
        found.push(format!(
            "{name}: the estimate {:+.3e}{space}{unit} is {:.1} standard deviations away from the known value",
            estimate.value,
            estimate.off()
        ));
    }
    found
}
