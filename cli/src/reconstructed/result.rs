//! The reconstruction of a recording.

use super::comparison::Comparison;
use crate::{Error, Recording};
use std::ops::Range;
use std::path::PathBuf;
use vibrissa::reconstruct::kink::Kink;
use vibrissa::reconstruct::{
    Assembly, Budget, ContourEstimate, Explanation, Finding, Plausibility, Travel, explanations,
    plausibility_with_friction, reconstruct_passes,
};
use vibrissa::{Label, Pose, Rod, Sample, Settings};

/// Most explanations that are told, and the least likelihood of one.
const MOST: usize = 5;
const LEAST: f64 = 0.005;

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
    /// What explains a recording that does not fit, the most likely first, with likelihoods that add up to 1.
    pub explanations: Vec<(Explanation, f64)>,
    /// The comparison with the truth, where that is known.
    pub comparison: Option<Comparison>,
}

/// Likelihood of bias and drift alone from which on nothing that is tried explains what does not fit.
const UNEXPLAINED: f64 = 0.5;

impl Reconstructed {
    /// Reconstructs a recording of this rod.
    ///
    /// # Errors
    /// [`Error::Reconstruction`]: too few samples are of use, or a setting is not possible.
    pub fn new(recording: Recording, rod: Rod, settings: &Settings) -> Result<Self, Error> {
        let usable = recording.rows.iter().enumerate().filter_map(|(row, sample)| Some((row, *sample.as_ref().ok()?)));
        let (rows, samples): (Vec<usize>, Vec<Sample>) = usable.unzip();
        let of = |settings: &Settings| {
            reconstruct_passes(&rod, &samples, settings)
                .map_err(|source| ReconstructionError { file: recording.file.clone(), source })
        };
        let is_gross = |check: &Plausibility| check.findings.iter().any(Finding::is_gross);
        let mut found = of(settings)?;
        let friction = found.frictions();
        let plausibility = |rod: &Rod, samples: &[Sample]| plausibility_with_friction(rod, samples, |k| friction[k]);
        let raw = plausibility(&rod, &samples);
        // the physics of what is left after the corrections: a bias alone may look like a wrong sign
        let mut check = raw.clone();
        if found.is_corrected() {
            let (corrected, used) = found.corrected(&rod, &samples);
            check = plausibility(&corrected, &used);
        }
        if is_gross(&check) || is_gross(&raw) && found.findings().iter().any(Finding::is_misfit) {
            // small errors mean nothing where units, signs or rod are wrong
            (found, check) = (of(&Settings { budget: Some(Budget::NONE), ..*settings })?, raw);
        }
        let contour = found.contour(&Assembly::default());
        check.findings.extend(found.findings());
        let name = recording.file.file_stem().unwrap_or(recording.file.as_os_str()).to_string_lossy().into_owned();
        Ok(Self {
            name,
            recording,
            rod,
            samples,
            rows,
            found,
            contour,
            check,
            explanations: Vec::new(),
            comparison: None,
        })
    }

    /// Looks for what explains the recording, where it does not fit for reasons that mistakes or errors may have. `settings` are those
    /// of the reconstruction.
    pub fn explain(&mut self, settings: &Settings) {
        let may_be = |finding: &Finding| {
            finding.is_misfit()
                && !matches!(finding, Finding::Coarse { .. } | Finding::NoFreeStretch | Finding::Frozen { .. })
        };
        if self.check.findings.iter().any(may_be) {
            self.explanations = explanations(&self.rod, &self.samples, settings, &self.check.findings);
        }
    }

    /// The likeliest explanations in words; none where none were looked for.
    pub fn explained(&self) -> Option<String> {
        // what does not fit is there with nothing but a bias, too
        if matches!(self.explanations.first(), Some((Explanation::Tare, share)) if *share > UNEXPLAINED) {
            return Some(
                "no likely cause among those that are tried (signs, axes, units, single errors of rod, sensor, clamp and stage): look for \
                 friction, taper, a loose clamp, an object that moves, or two mistakes at once"
                    .to_owned(),
            );
        }
        let told = self.explanations.iter().take(MOST).filter(|one| one.1 >= LEAST);
        let told: Vec<String> = told.map(|(what, share)| format!("{what}: {:.0} %", 100.0 * share)).collect();
        (!told.is_empty()).then(|| {
            format!(
                "likely causes, if it is one of those that are tried: {}; correct what is wrong, and reconstruct again",
                told.join("; ")
            )
        })
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
