//! The result of a reconstruction.

#[cfg(feature = "contact")]
use super::Settings;
use super::reading::{Reading, Reason};
use crate::contour::{Assembly, ContourEstimate, Gap, Measured, Trace, TraceKind};
#[cfg(feature = "contact")]
use crate::fit::ContourFit;
use crate::friction::FrictionEstimate;
use crate::kink::Kink;
use crate::phase::{Evidence, Label};
use crate::point::Touch;
use crate::scan::noise_estimate::ChannelNoise;
use crate::systematic::Calibration;
#[cfg(feature = "contact")]
use crate::systematic::Source;
#[cfg(feature = "contact")]
use nalgebra::Matrix2;
use rod_core::{Rod, Sample};
use std::ops::Range;

/// Number of independent values in a stretch with several contacts: its series have about as many significant terms. The samples of the
/// stretch share their noise accordingly.
const SERIES: usize = 8;
/// Most contact points of a trace that its systematic errors are taken from: they change little from point to point.
const PLACES: usize = 100;

/// A part of a recording in which the clamp goes on in one direction.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Its samples.
    pub samples: Range<usize>,
    /// What was found of the errors that its samples share; none where the budget has none, or where there are too few samples.
    pub calibration: Option<Calibration>,
    /// The coefficient of friction with which the pass was reconstructed, with the sign of [`FrictionEstimate::mu`]; 0 without.
    pub used_friction: f64,
    /// What the pass tells of friction, where that was asked for, or where it seems to be there though it was not.
    pub friction: Option<FrictionEstimate>,
}

impl Pass {
    /// The sign of friction as it was used, or as the pass tells it; 1 where nothing does.
    #[cfg(feature = "contact")]
    pub(crate) fn drawn(&self) -> f64 {
        let told = self.friction.map_or(1.0, |friction| friction.mu);
        1.0_f64.copysign(if self.used_friction == 0.0 { told } else { self.used_friction })
    }

    /// Takes the errors of a fit for its own: those of friction have the sign of the pass.
    #[cfg(feature = "contact")]
    fn adopt(&mut self, errors: &[(Source, f64, f64)]) {
        let drawn = self.drawn();
        let found = |source: Source| {
            let (_, value, sigma) = errors.iter().find(|error| error.0 == source)?;
            Some((if source == Source::Friction { drawn * value } else { *value }, *sigma))
        };
        for estimate in self.calibration.iter_mut().flat_map(|one| &mut one.sources) {
            match found(estimate.source) {
                Some((value, sigma)) => {
                    (estimate.value, estimate.taken, estimate.sigma) = (value, value, estimate.sigma.max(sigma));
                }
                // the contour is that of the errors as they are known
                None if estimate.source != Source::Friction => estimate.taken = estimate.known,
                None => {}
            }
        }
        if let Some((mu, sigma)) = found(Source::Friction).filter(|_| self.used_friction != 0.0) {
            self.used_friction = mu;
            if let Some(friction) = &mut self.friction {
                (friction.mu, friction.sigma) = (mu, friction.sigma.max(sigma));
            }
        }
    }
}

/// The result of a reconstruction.
#[derive(Clone, Debug)]
pub struct Reconstruction {
    /// One a sample, in order.
    pub readings: Vec<Reading>,
    /// Runs of samples with one label: the number of the first sample, and the label.
    pub runs: Vec<(usize, Label)>,
    /// Kinks and jumps of the reactions, SI units; `next` is the number of the first sample after each.
    pub kinks: Vec<Kink>,
    /// Noise of f0x, f0y (N) and m0z (N m) that was found or given.
    pub noise: [ChannelNoise; 3],
    /// Steps in which f0x, f0y (N) and m0z (N m) are given, where these are larger than the noise and hide transitions.
    pub steps: [Option<f64>; 3],
    /// The passes, one unless the clamp turns back.
    pub passes: Vec<Pass>,
    /// The evidence of each place.
    pub(super) evidence: Vec<Evidence>,
    /// Samples of each place's window; 1 where samples are used as they are.
    pub(super) windows: Vec<usize>,
}

/// Runs of samples with one label, from the numbers of those that can be used and their labels.
pub(super) fn runs(labels: impl Iterator<Item = (usize, Label)>) -> Vec<(usize, Label)> {
    let mut runs: Vec<(usize, Label)> = Vec::new();
    for (number, label) in labels {
        if runs.last().is_none_or(|run| run.1 != label) {
            runs.push((number, label));
        }
    }
    runs
}

impl Reconstruction {
    /// What was found of the errors that all samples share, in the first pass that says something of them.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.passes.iter().find_map(|pass| pass.calibration.as_ref())
    }

    /// Whether anything was taken off the samples of any pass.
    pub fn is_corrected(&self) -> bool {
        self.passes.iter().filter_map(|pass| pass.calibration.as_ref()).any(Calibration::is_applied)
    }

    /// The rod and the samples as they were used: without what was taken off in each pass.
    pub fn corrected(&self, rod: &Rod, samples: &[Sample]) -> (Rod, Vec<Sample>) {
        let of = |pass: &Pass| {
            let part = samples.get(pass.samples.clone()).unwrap_or_default();
            pass.calibration.as_ref().map_or_else(|| part.to_vec(), |calibration| calibration.corrected(rod, part))
        };
        let corrected = self.calibration().map_or(*rod, |calibration| calibration.rod(rod));
        (corrected, self.passes.iter().flat_map(of).collect())
    }

    /// The samples along which the label is the same, in order.
    pub fn phases(&self) -> impl Iterator<Item = (Range<usize>, Label)> + '_ {
        let ends = self.runs.iter().skip(1).map(|run| run.0).chain([self.readings.len()]);
        self.runs.iter().zip(ends).map(|(&(first, label), end)| (first..end, label))
    }

    /// Takes over the labels, contact points and shared errors of a contour that explains the recording, wherever it gives some; nothing changes
    /// where it does not explain it. `settings` are those of the reconstruction.
    #[cfg(feature = "contact")]
    pub fn adopt(&mut self, fit: &ContourFit, settings: &Settings) {
        if !fit.goodness.explains {
            return;
        }
        let largest = settings.largest_sigma * fit.length;
        let known = |touch: Touch| {
            let sigma = touch.sigma_normal();
            if sigma <= largest { Ok(touch) } else { Err(Reason::TooNoisy { sigma }) }
        };
        // the fit may have found another contour with other errors: what the local answer does not know of these stays unknown
        let mut shared = self
            .readings
            .iter()
            .find_map(|reading| reading.touch.ok())
            .map_or_else(Matrix2::zeros, |touch| touch.systematic);
        for (reading, answer) in self.readings.iter_mut().zip(&fit.readings) {
            if let Ok(touch) = reading.touch {
                shared = touch.systematic;
            }
            let with_shared = |touch: Touch| {
                known(Touch { covariance: touch.covariance + shared, systematic: touch.systematic + shared, ..touch })
            };
            if let (Some(answer), false) = (answer, matches!(reading.touch, Err(Reason::Fault(_)))) {
                let second = answer.second.map(|second| second.and_then(with_shared));
                *reading = Reading { touch: answer.touch.and_then(with_shared), second, ..*answer };
            }
        }
        let used = self.readings.iter().enumerate().filter(|(_, one)| !matches!(one.touch, Err(Reason::Fault(_))));
        self.runs = runs(used.map(|(number, one)| (number, one.label)));
        self.passes.iter_mut().for_each(|pass| pass.adopt(&fit.errors));
    }

    /// The contour: contact points assembled into stretches, and the gaps between them.
    ///
    /// In noise the points of neighbouring samples come from fits that overlap. Each point counts with its share of the window, so that
    /// the standard deviations of the contour are those of the noise of the samples.
    pub fn contour(&self, assembly: &Assembly) -> ContourEstimate {
        let mut whole = ContourEstimate::default();
        for pass in &self.passes {
            let part = self.of_pass(assembly, pass.samples.clone());
            let shifted = |samples: Range<usize>| samples.start + pass.samples.start..samples.end + pass.samples.start;
            whole
                .traces
                .extend(part.traces.into_iter().map(|trace| Trace { samples: shifted(trace.samples), ..trace }));
            whole.gaps.extend(part.gaps.into_iter().map(|gap| Gap { samples: shifted(gap.samples), ..gap }));
        }
        whole.traces.iter_mut().for_each(|trace| self.add_systematic(trace));
        whole
    }

    /// The contour of some consecutive samples, which are numbered from 0 in it.
    fn of_pass(&self, assembly: &Assembly, pass: Range<usize>) -> ContourEstimate {
        let readings = self.readings.get(pass.clone()).unwrap_or_default();
        let mut lengths = self.phases().map(|(samples, _)| (samples.end, samples.len()));
        let mut run = lengths.next();
        let mut touches: Vec<Touch> = Vec::with_capacity(readings.len());
        let answers: Vec<(Range<usize>, Option<String>, usize)> = readings
            .iter()
            .zip(pass)
            .map(|(reading, sample)| {
                while run.is_some_and(|(end, _)| end <= sample) {
                    run = lengths.next();
                }
                let window = match reading.second {
                    Some(_) => run.map_or(1, |(_, length)| length / SERIES),
                    // the points of a model share its noise as those of a stretch do
                    None => {
                        let of_model = || run.map_or(1, |(_, length)| length / SERIES);
                        self.windows.get(reading.place.0).copied().unwrap_or_else(of_model)
                    }
                };
                // the second contact is used with the first one only
                let second = reading.second.filter(|_| reading.touch.is_ok());
                let start = touches.len();
                touches.extend(std::iter::once(reading.touch).chain(second).filter_map(Result::ok));
                let reason = reading.touch.err().filter(|reason| *reason != Reason::Free);
                (start..touches.len(), reason.map(|reason| reason.to_string()), window)
            })
            .collect();
        assembly.assemble(readings.iter().zip(&answers).map(|(reading, (range, reason, shared))| Measured {
            reason: reason.as_deref(),
            shared: *shared,
            ..Measured::new(reading.label, &touches[range.clone()])
        }))
    }

    /// Adds to the points of a trace what all samples share, from the nearest of some contact points of its samples.
    fn add_systematic(&self, trace: &mut Trace) {
        let readings = self.readings.get(trace.samples.clone()).unwrap_or_default();
        let of = |reading: &Reading| match (trace.kind, reading.label.several()) {
            (TraceKind::Single, false) | (TraceKind::First, true) => reading.touch.ok(),
            (TraceKind::Second, true) => reading.second.and_then(Result::ok),
            _ => None,
        };
        let step = readings.len().div_ceil(PLACES).max(1);
        let touches: Vec<Touch> = readings.iter().step_by(step).filter_map(of).collect();
        for point in &mut trace.points {
            let distance = |touch: &Touch| (touch.x - point.x).hypot(touch.y - point.y);
            let nearest = touches.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(touch) = nearest {
                point.systematic = touch.sigma_systematic();
                point.sigma = point.sigma.hypot(point.systematic);
            }
        }
    }

    /// The coefficient of friction with which each sample was reconstructed, with the sign of [`FrictionEstimate::mu`]; 0 without.
    pub fn frictions(&self) -> Vec<f64> {
        self.passes.iter().flat_map(|pass| std::iter::repeat_n(pass.used_friction, pass.samples.len())).collect()
    }

    /// The criteria at the place nearest to a sample, dimensionless; none for a sample that cannot be used.
    pub fn evidence(&self, sample: usize) -> Option<&Evidence> {
        self.readings.get(sample).and_then(|reading| self.evidence.get(reading.place.0))
    }
}
