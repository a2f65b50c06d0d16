//! What was found of the errors that all samples share.

use super::correction::{Correction, Frame};
use super::source::{Errors, Source};
use crate::scan::{Fault, Track, TrackIndex};
use nalgebra::DMatrix;
use rod_core::{Rod, Sample};
use std::ops::Range;

/// Correlation of two estimates from which on scans do not tell them apart.
const TIED: f64 = 0.9;
/// Part of a variance that another source is named for.
const CONFUSED: f64 = 0.1;
/// Standard deviations beyond which an estimate contradicts what was known.
pub(crate) const BEYOND: f64 = 3.0;

/// One source of error: what was known, and what the scan says.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SourceEstimate {
    /// Which.
    pub source: Source,
    /// What was known of it before, 0 where nothing was, in the unit of the source.
    pub known: f64,
    /// Standard deviation of that, or of the budget that was given.
    pub given: f64,
    /// The one that was used: larger where the data ask for it.
    pub budget: f64,
    /// The estimate.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// What was taken off the samples: the estimate, or, where the scan agrees with the model without it, what was known before. In the
    /// second case the standard deviations of the contact points contain the estimate.
    pub taken: f64,
    /// Whether the budget was too small for the data, and was raised.
    pub raised: bool,
}

impl SourceEstimate {
    /// How many standard deviations of what was known before the estimate is off that.
    pub fn off(&self) -> f64 {
        if self.value == self.known { 0.0 } else { (self.value - self.known).abs() / self.given }
    }

    /// Whether it contradicts what was known before: it is off by more than three standard deviations.
    pub fn is_beyond(&self) -> bool {
        self.off() > BEYOND
    }

    /// Whether the scan says more of it than the budget: its standard deviation is at most half of that.
    pub fn is_identified(&self) -> bool {
        self.sigma <= 0.5 * self.budget && self.budget > 0.0
    }
}

/// The errors that all samples of a scan share, as the scan itself tells them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Calibration {
    /// The sources that the budget has, and those of which something was known.
    pub sources: Vec<SourceEstimate>,
    /// Covariance of their estimates, in the order and the units of the sources. It is not a part of serialised data; deserialised, it
    /// has no rows.
    #[cfg_attr(feature = "serde", serde(skip, default = "empty"))]
    pub covariance: DMatrix<f64>,
    /// Pairs that the scan does not tell apart: their estimates have a correlation beyond 0.9 in size, which is given.
    pub ties: Vec<(Source, Source, f64)>,
    /// Stretches of samples in which the rod is free, by the numbers of usable samples.
    pub free: Vec<Range<usize>>,
    /// 1 where the rod is drawn back over its contacts, -1 where it is pushed on, as kinematics alone tell: the sign that friction has.
    /// 1 where friction is not estimated.
    pub direction: f64,
    /// Natural logarithm of the likelihood of labels and errors together, but for a constant of the recording. It compares
    /// interpretations of one recording, as with another sign of a channel.
    pub log_likelihood: f64,
    /// What is left of the phase criterion K along tangential contacts beyond its noise, in parts of what the budget let it be: 0
    /// where model and scan agree.
    pub misfit_criterion: f64,
    /// The same of the length criterion along contacts of the tip.
    pub misfit_length: f64,
    /// The same of the tangent criterion along single contacts.
    pub misfit_tangent: f64,
}

#[cfg(feature = "serde")]
fn empty() -> DMatrix<f64> {
    DMatrix::zeros(0, 0)
}

impl Calibration {
    /// The samples of the scan without what was taken off, as of [`Self::rod`]. Of a rod with natural curvature the moment is less by what
    /// would bend a straight rod to it.
    pub fn corrected(&self, given: &Rod, samples: &[Sample]) -> Vec<Sample> {
        let taken = Errors::from_fn(|k, _| {
            let source = Source::ALL[k];
            self.source(source).map_or(0.0, |estimate| estimate.taken / source.unit(given))
        });
        let (track, indices) = Track::new(given, samples);
        let correction =
            Frame::of(&track).filter(|_| self.is_applied()).and_then(|frame| Correction::new(frame, &taken));
        let Some(correction) = correction else { return samples.to_vec() };
        let (corrected, units) = (correction.track(&track), self.rod(given).units());
        let of = |(sample, index): (&Sample, Result<TrackIndex, Fault>)| match index {
            Ok(index) => corrected.clamps[index.0].sample(units, sample),
            Err(_) => *sample,
        };
        samples.iter().zip(indices).map(of).collect()
    }

    /// What was taken off for bias and drift, dimensionless.
    pub(crate) fn tare(&self, given: &Rod) -> Errors {
        let taken = |source: Source| self.source(source).map_or(0.0, |estimate| estimate.taken / source.unit(given));
        Errors::from_fn(|k, _| if Source::ALL[k] <= Source::BowM0z { taken(Source::ALL[k]) } else { 0.0 })
    }

    /// Counts a source from another origin.
    pub(crate) fn shift(&mut self, source: Source, by: f64) {
        for estimate in self.sources.iter_mut().filter(|estimate| estimate.source == source) {
            estimate.known += by;
            estimate.value += by;
            estimate.taken += by;
        }
    }

    /// Whether anything was taken off the samples: friction changes what follows from them, not the samples.
    pub fn is_applied(&self) -> bool {
        self.sources.iter().any(|estimate| estimate.taken != 0.0 && estimate.source != Source::Friction)
    }

    /// The rod with stiffness and length as they were found, if that was needed; otherwise the given one.
    pub fn rod(&self, given: &Rod) -> Rod {
        let value = |source| self.source(source).map_or(0.0, |estimate| estimate.taken);
        let (length, stiffness) = (value(Source::Length), value(Source::Stiffness));
        Rod::new(given.length() * (1.0 + length), given.bending_stiffness() * (1.0 + stiffness)).unwrap_or(*given)
    }

    /// The sources that the scan separates poorly from this one: the part by which the variance of its estimate would be smaller if they were known
    /// exactly, one by one, a tenth at least; the largest first. Empty where the source was not estimated.
    pub fn confounders(&self, source: Source) -> Vec<(Source, f64)> {
        let of = self.sources.iter().position(|estimate| estimate.source == source);
        of.filter(|of| *of < self.covariance.nrows())
            .map_or_else(Vec::new, |of| confounders_of(&self.sources, &self.covariance, of))
    }

    /// The estimate of one source.
    pub fn source(&self, source: Source) -> Option<&SourceEstimate> {
        self.sources.iter().find(|estimate| estimate.source == source)
    }
}

/// The sources that are poorly separated from one, by its number: the part by which its variance would be smaller if they were known exactly, one by
/// one, a tenth at least; the largest first.
pub(super) fn confounders_of(sources: &[SourceEstimate], covariance: &DMatrix<f64>, of: usize) -> Vec<(Source, f64)> {
    let part = |k: usize| covariance[(of, k)].powi(2) / (covariance[(of, of)] * covariance[(k, k)]);
    let others = (0..covariance.nrows()).filter(|k| *k != of).map(|k| (sources[k].source, part(k)));
    let mut found: Vec<(Source, f64)> = others.filter(|other| other.1 > CONFUSED).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// The pairs of sources that scans do not tell apart, with the correlation of their estimates.
pub(super) fn ties(sources: &[SourceEstimate], covariance: &DMatrix<f64>) -> Vec<(Source, Source, f64)> {
    let pairs = (0..sources.len()).flat_map(|i| (i + 1..sources.len()).map(move |j| (i, j)));
    let correlated = pairs.map(|(i, j)| {
        let correlation = covariance[(i, j)] / (sources[i].sigma * sources[j].sigma);
        (sources[i].source, sources[j].source, correlation)
    });
    correlated.filter(|tie| tie.2.abs() > TIED).collect()
}
