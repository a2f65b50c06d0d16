//! The reconstruction of a recording.

use super::comparison::Comparison;
use crate::{Error, Recording};
use std::ops::Range;
use std::path::PathBuf;
use vibrissa::reconstruct::kink::Kink;
use vibrissa::reconstruct::{
    Assembly, Budget, ContourEstimate, Finding, Plausibility, Travel, plausibility, reconstruct_passes,
};
use vibrissa::{Label, Pose, Rod, Sample, Settings};

/// Why a recording cannot be reconstructed.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", file.display())]
pub struct ReconstructionError {
    /// Which recording.
    pub file: PathBuf,
    /// Why.
    pub source: vibrissa::reconstruct::ReconstructError,
}

/// The reconstruction of a recording.
#[derive(Debug)]
pub struct Reconstructed {
    /// The name of the recording without its extension.
    pub name: String,
    /// The recording.
    pub recording: Recording,
    /// The rod that is assumed.
    pub rod: Rod,
    /// The samples of its usable rows.
    pub samples: Vec<Sample>,
    /// Numbers of those rows, from 0.
    pub rows: Vec<usize>,
    /// The result, one reading per sample.
    pub found: vibrissa::reconstruct::Reconstruction,
    /// The contour. Its samples are numbered as `samples`.
    pub contour: ContourEstimate,
    /// The check of the recording by the physics.
    pub check: Plausibility,
    /// The comparison with the truth, where that is known.
    pub comparison: Option<Comparison>,
}

impl Reconstructed {
    /// Reconstructs a recording of this rod.
    ///
    /// # Errors
    /// [`Error::Reconstruction`]: too few samples are of use, or a setting is not possible.
    pub fn new(recording: Recording, rod: Rod, settings: &Settings) -> Result<Self, Error> {
        let usable = recording.rows.iter().enumerate().filter_map(|(row, sample)| Some((row, *sample.as_ref().ok()?)));
        let (rows, samples): (Vec<usize>, Vec<Sample>) = usable.unzip();
        let raw = plausibility(&rod, &samples);
        let gross = raw.findings.iter().any(Finding::is_gross);
        // small errors mean nothing where units, signs or rod are wrong
        let settings = if gross { Settings { budget: Some(Budget::NONE), ..*settings } } else { *settings };
        let found = reconstruct_passes(&rod, &samples, &settings)
            .map_err(|source| ReconstructionError { file: recording.file.clone(), source })?;
        let contour = found.contour(&Assembly::default());
        // the physics of what is left after the corrections
        let mut check = if found.is_corrected() && !gross {
            let (corrected, used) = found.corrected(&rod, &samples);
            plausibility(&corrected, &used)
        } else {
            raw
        };
        check.findings.extend(found.findings());
        let name = recording.file.file_stem().unwrap_or(recording.file.as_os_str()).to_string_lossy().into_owned();
        Ok(Self { name, recording, rod, samples, rows, found, contour, check, comparison: None })
    }

    /// The runs of samples with one label, in order.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Range<usize>, Label)> + '_ {
        let runs = &self.found.runs;
        let ends = runs.iter().skip(1).map(|run| run.0).chain([self.samples.len()]);
        runs.iter().zip(ends).map(|(&(first, label), end)| (first..end, label))
    }

    /// The poses of the clamp at the kinks, interpolated between the samples on either side.
    pub(crate) fn kink_poses(&self) -> Vec<Pose> {
        let mut travel = Travel::new(&self.rod);
        let ways: Vec<f64> = self.samples.iter().map(|s| travel.go(&s.pose).unwrap_or(f64::NAN)).collect();
        let pose = |kink: &Kink| {
            let after = kink.next.clamp(1, self.samples.len() - 1);
            let [a, b] = [after - 1, after].map(|k| self.samples[k].pose);
            let part = (kink.tau - ways[after - 1]) / (ways[after] - ways[after - 1]);
            let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
            let between = |a: f64, b: f64| a + part * (b - a);
            Pose { x: between(a.x, b.x), y: between(a.y, b.y), phi: between(a.phi, b.phi) }
        };
        self.found.kinks.iter().map(pose).collect()
    }
}
