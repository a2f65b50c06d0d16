//! What a reconstruction itself finds wrong with the recording.

use super::reading::{Reading, Reason};
use super::reconstruction::{Pass, Reconstruction};
use crate::check::Finding;
use crate::friction::{FrictionAlone, FrictionEstimate, SPREAD};
use crate::kink::{Kink, KinkKind};
use crate::phase::{Basis, Label};
use crate::scan::Fault;
use crate::systematic::{Calibration, Source};
use std::ops::Range;

/// What is left of a criterion, in parts of what the budget let it be, from which on the model does not explain the scan.
const MISFIT: f64 = 0.2;
/// Share of single contacts without a contact point that is reported.
const UNANSWERED: f64 = 0.25;
/// Share of all contacts without a contact point that is reported.
const LOST: f64 = 0.75;
/// Share of wrong labels to be expected that is reported, and of those of a contour that explains the recording: these allow for shared errors of a
/// laboratory, and are expected at 1 % of the labels of ordinary scans.
const UNCERTAIN: f64 = 0.01;
const UNDETERMINED: f64 = 0.03;
/// Part of the wrong labels to be expected that a run has which is named.
const MUCH: f64 = 0.1;
/// Share of the tangential path along which the rod slides against friction that is reported: the rest is noise of the rates.
const AGAINST: f64 = 0.2;
/// How much the coefficient of friction may vary along a pass, in multiples of its noise.
const SCATTERED: f64 = 3.0;
/// Part of its budget to which the scan must determine a bias, where no stretch is of a free rod.
const KNOWN: f64 = 0.3;

impl Reconstruction {
    /// What the reconstruction itself finds wrong with the recording: no free stretch, an error beyond its budget, criteria that are not
    /// met, samples without an answer. Empty where everything fits.
    pub fn findings(&self) -> Vec<Finding> {
        let mut findings = self
            .passes
            .iter()
            .filter_map(|pass| pass.calibration.as_ref())
            .flat_map(of_calibration)
            .collect::<Vec<_>>();
        findings.extend(self.passes.iter().flat_map(of_friction));
        // where forces contradict that the rod is free, it is in contact
        let free = |reading: &Reading| reading.label == Label::Free && reading.touch == Err(Reason::Free);
        let single = || self.readings.iter().filter(|reading| !reading.label.several() && !free(reading));
        let unanswered = single().filter(|reading| reading.touch.is_err()).count();
        let share = unanswered as f64 / single().count().max(1) as f64;
        if share > UNANSWERED {
            findings.push(Finding::Unanswered { share });
        }
        let channels = ["f0x", "f0y", "m0z"].into_iter().zip(self.steps);
        findings.extend(channels.filter_map(|(channel, step)| Some(Finding::Coarse { channel, step: step? })));
        let touching = || self.readings.iter().filter(|reading| !free(reading));
        let (touched, lost) = (touching().count(), touching().filter(|reading| reading.touch.is_err()).count());
        if lost as f64 > LOST * touched as f64 {
            findings.push(Finding::Lost { share: lost as f64 / touched as f64 });
        }
        let is_frozen = |reading: &Reading| reading.touch == Err(Reason::Fault(Fault::Frozen));
        let frozen = self.readings.iter().filter(|reading| is_frozen(reading)).count();
        // what does not fit makes labels uncertain, too
        if findings.is_empty() {
            findings.extend(self.uncertain(UNCERTAIN, false));
        }
        findings.extend(self.kinks_within());
        if let Some(from) = self.readings.iter().position(is_frozen) {
            findings.push(Finding::Frozen { share: frozen as f64 / self.readings.len() as f64, from });
        }
        findings
    }

    /// The kinks of a noisy scan that are within a phase B: noise may hide another contact there.
    fn kinks_within(&self) -> Option<Finding> {
        let is_noisy = self.windows.iter().any(|window| *window > 1);
        let label = |row: usize| self.readings.get(row).map(|reading| reading.label);
        let within = |kink: &&Kink| {
            let sides = [kink.next.checked_sub(1).and_then(label), label(kink.next)];
            kink.kind == KinkKind::Kink && sides == [Some(Label::B); 2]
        };
        let mut kinks = self.kinks.iter().filter(within);
        let from = kinks.next().filter(|_| is_noisy)?.next;
        Some(Finding::KinksWithin { count: 1 + kinks.count(), from })
    }

    /// The labels that a contour leaves open which explains the recording ([`Reconstruction::adopt`]), where there are many.
    pub fn undetermined(&self) -> Option<Finding> {
        self.uncertain(UNDETERMINED, true)
    }

    /// The labels that are to be expected wrong, where their share exceeds `least`, with the run that is least sure.
    fn uncertain(&self, least: f64, is_explained: bool) -> Option<Finding> {
        let wrong = |samples: &[Reading]| {
            let used = samples.iter().filter(|reading| !matches!(reading.touch, Err(Reason::Fault(_))));
            used.map(|reading| 1.0 - reading.probability).sum::<f64>()
        };
        let share = wrong(&self.readings) / self.readings.len().max(1) as f64;
        let counted =
            self.phases().map(|(run, label)| (wrong(self.readings.get(run.clone()).unwrap_or_default()), run, label));
        // the run whose labels are least sure, of those that count
        let counted = counted.filter(|(wrong, ..)| *wrong > MUCH * share * self.readings.len() as f64);
        let doubt = |run: &Range<usize>, wrong: f64| wrong / run.len().max(1) as f64;
        let (_, run, label) = counted.max_by(|u, v| doubt(&u.1, u.0).total_cmp(&doubt(&v.1, v.0)))?;
        (share > least).then_some(Finding::Uncertain { share, label, from: run.start, to: run.end, is_explained })
    }
}

/// Friction that was not asked for, and friction that is not what was asked for.
fn of_friction(pass: &Pass) -> Option<Finding> {
    let FrictionEstimate { mu, sigma, scatter, spread, gain, against, alone, .. } = pass.friction?;
    if pass.used_friction == 0.0 {
        return pass.friction.filter(FrictionEstimate::is_significant).map(|_| Finding::Friction { mu, sigma, gain });
    }
    // the direction of what is not there says nothing
    if against > AGAINST && pass.friction.is_some_and(|found| found.is_significant()) {
        return Some(Finding::FrictionAgainst { mu, share: against });
    }
    // that it seems to vary is a consequence
    if let Some(FrictionAlone { mu, sigma, given, deviation }) = alone.filter(FrictionAlone::contradicts) {
        return Some(Finding::FrictionGiven { given, mu, sigma, deviation });
    }
    (scatter > SCATTERED && spread > SPREAD).then_some(Finding::FrictionChanges { mu, scatter, spread })
}

fn of_calibration(calibration: &Calibration) -> Vec<Finding> {
    let mut findings = Vec::new();
    let biases = [Source::BiasF0x, Source::BiasF0y, Source::BiasM0z].map(|source| calibration.source(source));
    if calibration.free.is_empty() && biases.iter().flatten().any(|bias| bias.sigma > KNOWN * bias.budget) {
        findings.push(Finding::NoFreeStretch);
    }
    for estimate in calibration.sources.iter().filter(|estimate| estimate.is_beyond()) {
        let (of, value, sigma, budget) = (estimate.source, estimate.value, estimate.sigma, estimate.given);
        findings.push(Finding::Budget { of, value, sigma, budget });
    }
    let misfits = [
        (Basis::Criterion, calibration.misfit_criterion),
        (Basis::Length, calibration.misfit_length),
        (Basis::Tangent, calibration.misfit_tangent),
    ];
    let large = misfits.into_iter().filter(|(_, part)| *part > MISFIT);
    findings.extend(large.map(|(criterion, part)| Finding::Misfit { criterion, part }));
    findings
}
