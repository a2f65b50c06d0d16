//! The reconstruction of a recording.

use super::comparison::Comparison;
use crate::Recording;
use std::ops::Range;
use std::path::PathBuf;
use vibrissa::reconstruct::kink::Kink;
use vibrissa::reconstruct::{
    Assembly, Budget, ContourEstimate, ContourFit, Explanation, Finding, FitError, Friction, Plausibility,
    ReconstructError, Reconstruction, Travel, explanations, fit_contour, plausibility_with_friction,
    reconstruct_general, reconstruct_passes,
};
use vibrissa::rod::{AnyRod, PhysicalRod};
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
    pub source: ReconstructError,
}

/// The reconstruction of a recording.
#[derive(Debug)]
pub struct Reconstructed {
    /// The name of the recording without its extension.
    pub name: String,
    /// The recording.
    pub recording: Recording,
    /// The rod that is assumed.
    pub rod: AnyRod,
    /// The samples of its usable rows. Of a uniform rod on springs the poses are those of its base.
    pub samples: Vec<Sample>,
    /// Numbers of those rows, from 0.
    pub rows: Vec<usize>,
    /// The result, one reading per sample.
    pub found: Reconstruction,
    /// The contour. Its samples are numbered as `samples`.
    pub contour: ContourEstimate,
    /// The check of the recording by the physics. Of a rod that is not uniform or not straight at rest it has no line and no shares, only
    /// findings.
    pub check: Plausibility,
    /// What explains a recording that does not fit, the most likely first, with likelihoods that add up to 1.
    pub explanations: Vec<(Explanation, f64)>,
    /// The contour that explains the whole recording best, or why there is none; none where it was not looked for.
    pub fit: Option<Result<ContourFit, FitError>>,
    /// Runs of samples with several contacts of that contour in which each sample alone was answered by one.
    pub several_only_in_fit: Vec<Range<usize>>,
    /// The comparison with the truth, where that is known.
    pub comparison: Option<Comparison>,
}

/// Likelihood of bias and drift alone from which on nothing that is tried explains what does not fit.
const UNEXPLAINED: f64 = 0.5;

impl Reconstructed {
    /// Reconstructs a recording of this rod, whose poses are those of the support of its clamp.
    ///
    /// # Errors
    /// [`ReconstructionError`]: too few samples are of use, or a setting is not possible.
    pub fn new(recording: Recording, rod: impl Into<AnyRod>, settings: &Settings) -> Result<Self, ReconstructionError> {
        let rod = rod.into();
        let recording = if rod.uniform().is_some() { recording.at_base(&rod) } else { recording };
        let usable = recording.rows.iter().enumerate().filter_map(|(row, sample)| Some((row, *sample.as_ref().ok()?)));
        let (rows, samples): (Vec<usize>, Vec<Sample>) = usable.unzip();
        let found = match rod.uniform() {
            Some(uniform) => of_uniform(uniform, &samples, settings),
            None => of_varying(&rod, &samples, settings),
        };
        let (found, check, explanations) =
            found.map_err(|source| ReconstructionError { file: recording.file.clone(), source })?;
        let contour = found.contour(&Assembly::default());
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
            explanations,
            fit: None,
            several_only_in_fit: Vec::new(),
            comparison: None,
        })
    }

    /// Fits a contour to the whole recording, from the result on: whether a rod past one contour gives these reactions. Where one does, labels,
    /// points and shared errors are its own from now on. Nothing is fitted where a mistake in signs, units or rod explains the recording. `settings`
    /// are those of the reconstruction.
    pub fn fit(&mut self, settings: &Settings) {
        if self.check.findings.iter().any(Finding::is_gross) && is_mistake(&self.explanations) {
            return;
        }
        let fit = match self.rod.uniform() {
            Some(rod) => fit_contour(rod, &self.samples, &self.found),
            None => fit_contour(&self.rod, &self.samples, &self.found),
        };
        self.take(fit, settings);
    }

    /// Takes a fit over.
    pub(super) fn take(&mut self, fit: Result<ContourFit, FitError>, settings: &Settings) {
        if let Ok(fit) = &fit
            && fit.goodness.explains
        {
            let before: Vec<Label> = self.found.readings.iter().map(|reading| reading.label).collect();
            self.found.adopt(fit, settings);
            self.explanations.clear();
            let is_one = |label: Label| !label.several() && label != Label::Free;
            let after = self.found.readings.iter().map(|reading| reading.label);
            let several = before.into_iter().zip(after).enumerate();
            self.several_only_in_fit.clear();
            for (k, _) in several.filter(|(_, (before, after))| is_one(*before) && after.several()) {
                match self.several_only_in_fit.last_mut().filter(|run| run.end == k) {
                    Some(run) => run.end = k + 1,
                    None => self.several_only_in_fit.push(k..k + 1),
                }
            }
            self.contour = self.found.contour(&Assembly::default());
            // labels are those of the contour now
            let findings = &mut self.check.findings;
            let is_within = |finding: &Finding| matches!(finding, Finding::KinksWithin { .. });
            let had_kinks = findings.iter().any(is_within);
            let is_free = self.found.readings.iter().any(|reading| reading.label == Label::Free);
            findings.retain(|finding| match finding {
                Finding::Uncertain { .. } => false,
                // the local answer may miss the samples without contact that the contour has
                Finding::NoFreeStretch => !is_free,
                // of the corrections and of the missing points of the local answer: the contour has its own
                Finding::Misfit { .. } | Finding::Unanswered { .. } | Finding::Lost { .. } => false,
                _ => !is_within(finding),
            });
            let kinks = fit.unexplained_kinks(&self.found.kinks, &self.found.readings).filter(|_| had_kinks);
            self.check.findings.extend(kinks);
            self.check.findings.extend(self.found.undetermined());
            if settings.friction == Friction::None
                && let Some((mu, sigma)) = fit.friction_beside_errors()
            {
                self.check.findings.retain(|finding| !matches!(finding, Finding::Friction { .. }));
                // of the likelihood to second order
                let gain = 0.5 * (mu / sigma).powi(2);
                self.check.findings.push(Finding::Friction { mu, sigma, gain });
            }
        }
        self.fit = Some(fit);
    }

    /// What is not there because the rod is not uniform or not straight at rest, in words; none for one that is.
    pub fn missing(&self) -> Option<&'static str> {
        self.rod.uniform().is_none().then_some(
            "not computed for a rod that is not uniform or not straight at rest: the check by the \
             physics, likely causes of a misfit, and, where no contour explains the recording, the change from BB to BA within a stretch of two \
             contacts, where the errors of points may exceed their standard deviations",
        )
    }

    /// Looks for what explains the recording, where it does not fit for reasons that mistakes or errors may have; nothing where the rod is
    /// not uniform or not straight at rest. `settings` are those of the reconstruction.
    pub fn explain(&mut self, settings: &Settings) {
        let Some(rod) = self.rod.uniform() else { return };
        let may_be = |finding: &Finding| {
            finding.is_misfit()
                && !matches!(finding, Finding::Coarse { .. } | Finding::NoFreeStretch | Finding::Frozen { .. })
        };
        if self.explanations.is_empty() && self.check.findings.iter().any(may_be) {
            self.explanations = explanations(rod, &self.samples, settings, &self.check.findings);
        }
    }

    /// The likeliest explanations in words; none where none were looked for.
    pub fn explained(&self) -> Option<String> {
        // what does not fit is there with nothing but a bias, too
        if matches!(self.explanations.first(), Some((Explanation::Tare, share)) if *share > UNEXPLAINED) {
            return Some(
                "none of the tested causes is likely (signs, axes, units, single errors of rod, sensor, clamp and stage): look for \
                 friction, a rod that tapers or is bent at rest, a loose clamp, an object that moves, or two mistakes at once"
                    .to_owned(),
            );
        }
        let told = self.explanations.iter().take(MOST).filter(|one| one.1 >= LEAST);
        let told: Vec<String> = told.map(|(what, share)| format!("{what}: {:.0} %", 100.0 * share)).collect();
        (!told.is_empty()).then(|| {
            format!(
                "likely causes among the tested ones: {}; not tested: a rod that tapers or is bent at rest (`tip_diameter`, \
                 `natural_curvature` of [rod]), and two mistakes at once; correct the cause, and reconstruct again",
                told.join("; ")
            )
        })
    }

    /// The runs of samples with one label, in order.
    pub fn runs(&self) -> impl Iterator<Item = (Range<usize>, Label)> + '_ {
        self.found.phases()
    }

    /// The pose of the support of the clamp at a sample, as it was recorded.
    pub fn pose(&self, sample: usize) -> Pose {
        let Sample { pose, reactions, .. } = self.samples[sample];
        if self.rod.uniform().is_none() || self.rod.springs().is_none() {
            return pose;
        }
        // the springs yield by the reactions, wherever the support is
        let there = self.rod.base(pose, &reactions);
        Pose { x: 2.0 * pose.x - there.x, y: 2.0 * pose.y - there.y, phi: 2.0 * pose.phi - there.phi }
    }

    /// The poses of the support of the clamp at the kinks, interpolated between the samples on either side.
    pub fn kink_poses(&self) -> Vec<Pose> {
        let mut travel = Travel::new(self.rod.at_clamp());
        let ways: Vec<f64> = self.samples.iter().map(|s| travel.go(&s.pose).unwrap_or(f64::NAN)).collect();
        let pose = |kink: &Kink| {
            let after = kink.next.clamp(1, self.samples.len() - 1);
            let [a, b] = [after - 1, after].map(|k| self.pose(k));
            let part = (kink.tau - ways[after - 1]) / (ways[after] - ways[after - 1]);
            let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
            let between = |a: f64, b: f64| a + part * (b - a);
            Pose { x: between(a.x, b.x), y: between(a.y, b.y), phi: between(a.phi, b.phi) }
        };
        self.found.kinks.iter().map(pose).collect()
    }
}

/// A reconstruction, the check of it, and what explains gross findings of that; nothing without such.
type Checked = Result<(Reconstruction, Plausibility, Vec<(Explanation, f64)>), ReconstructError>;

/// Whether a mistake in signs, units or rod explains the recording best, or nothing does.
fn is_mistake(explanations: &[(Explanation, f64)]) -> bool {
    explanations.first().is_none_or(|first| matches!(first.0, Explanation::Mistake(_)))
}

/// With the errors that all samples share taken off, unless gross mistakes leave no sense in them.
fn of_uniform(rod: &Rod, samples: &[Sample], settings: &Settings) -> Checked {
    let is_gross = |check: &Plausibility| check.findings.iter().any(Finding::is_gross);
    let mut found = reconstruct_passes(rod, samples, settings)?;
    let friction = found.frictions();
    let plausibility = |rod: &Rod, samples: &[Sample]| plausibility_with_friction(rod, samples, |k| friction[k]);
    let raw = plausibility(rod, samples);
    // the physics of what is left after the corrections: a bias alone may look like a wrong sign
    let mut check = raw.clone();
    if found.is_corrected() {
        let (corrected, used) = found.corrected(rod, samples);
        check = plausibility(&corrected, &used);
    }
    let mut causes = Vec::new();
    if is_gross(&check) || is_gross(&raw) && found.findings().iter().any(Finding::is_misfit) {
        causes = explanations(rod, samples, settings, &raw.findings);
        if is_mistake(&causes) {
            // small errors mean nothing where units, signs or rod are wrong
            let as_is = Settings { budget: Some(Budget::NONE), ..*settings };
            (found, check) = (reconstruct_passes(rod, samples, &as_is)?, raw);
        }
    }
    check.findings.extend(found.findings());
    Ok((found, check, causes))
}

/// With the samples as they are.
fn of_varying(rod: &AnyRod, samples: &[Sample], settings: &Settings) -> Checked {
    let found = reconstruct_general(rod, samples, settings)?;
    let check = Plausibility { findings: found.findings(), ..Plausibility::default() };
    Ok((found, check, Vec::new()))
}
