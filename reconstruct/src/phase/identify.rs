//! The phases of a whole scan.

use super::border::border;
use super::diagram::Break;
use super::evidence::Evidence;
use super::label::Label;
use super::trellis::{Observation, Trellis, viterbi_step};
use crate::point::Inverse;
use crate::scan::{LocalCubic, Noise, Track};
use std::ops::Range;

/// Independent values of the evidence in a window: a cubic has four coefficients, hence three rates.
const INDEPENDENT: f64 = 3.0;
/// Places per window.
const PLACES: usize = 8;
/// Most samples of a window on one side of a place. Larger: less noise in slow scans, and more time.
const WIDEST: usize = 2000;

/// The number of a [`Place`] among those of its scan or pass, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PlaceNumber(pub(crate) usize);

impl PlaceNumber {
    /// Of a sample without a place.
    pub const NONE: Self = Self(usize::MAX);
}

/// A place of a scan where the criteria are evaluated: a usable sample, the fit about it and its evidence. Counted by [`PlaceNumber`].
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The track index of its sample.
    pub index: usize,
    pub fit: LocalCubic,
    pub evidence: Evidence,
    /// Its share of the samples of its window, which overlaps those of its neighbours.
    pub weight: f64,
    pub observation: Observation,
}

impl Place {
    /// The place at a track index, from samples of `part` only, at most `widest` on one side; none where these are too few.
    pub fn about<I: Inverse>(
        rod: &I,
        track: &Track,
        index: usize,
        part: Range<usize>,
        noise: &Noise,
        widest: usize,
    ) -> Option<Self> {
        let fit = LocalCubic::about(track, index, part, noise, widest)?;
        let evidence = Evidence::of(rod, &fit.at(track.tau[index]));
        Some(Self { index, fit, evidence, weight: 1.0, observation: Observation { scores: [0.0; 5], between: None } })
    }

    /// This place as one of a sequence of places that are `stride` samples apart, with the break before it. Overlapping windows contain the same
    /// samples, so that each place has the weight of its share.
    pub fn in_sequence(self, stride: usize, between: Option<Break>) -> Self {
        let weight = (INDEPENDENT * stride as f64 / self.fit.window.len() as f64).min(1.0);
        let observation = Observation { scores: self.evidence.scores().map(|score| weight * score), between };
        Self { observation, weight, ..self }
    }

    /// Replaces the evidence.
    pub fn set_evidence(&mut self, evidence: Evidence) {
        self.observation.scores = evidence.scores().map(|score| self.weight * score);
        self.evidence = evidence;
    }
}

/// The phases of a scan.
#[derive(Clone, Debug)]
pub(crate) struct ScanPhases {
    pub places: Vec<Place>,
    /// Runs of samples with one label, as ranges of track indices, in order, without gaps.
    pub runs: Vec<(Range<usize>, Label)>,
    /// The label of each place and its probability.
    pub labels: Vec<(Label, f64)>,
}

/// The parts between breaks, as ranges of track indices, with the break before each. `samples` is the length of the track.
pub(crate) fn parts(samples: usize, breaks: &[Break]) -> Vec<(Range<usize>, Option<Break>)> {
    let mut parts = Vec::with_capacity(breaks.len() + 1);
    let (mut start, mut before) = (0, None);
    for &here in breaks {
        if here.index > start && here.index < samples {
            parts.push((start..here.index, before));
            (start, before) = (here.index, Some(here));
        }
    }
    parts.push((start..samples, before));
    parts
}

/// Evaluates the criteria at places of a scan whose reactions break at `breaks`.
pub(crate) fn evaluate_places<I: Inverse>(rod: &I, track: &Track, noise: &Noise, breaks: &[Break]) -> Vec<Place> {
    let mut places = Vec::new();
    for (part, before) in parts(track.tau.len(), breaks) {
        let mut between = before;
        let mut index = part.start;
        // a part with too few samples for a fit has no place, and takes the label of its neighbours
        while let Some(place) = Place::about(rod, track, index, part.clone(), noise, WIDEST) {
            let stride = (place.fit.window.len() / PLACES).max(1);
            places.push(place.in_sequence(stride, between.take()));
            if index + 1 >= part.end {
                break;
            }
            index = (index + stride).min(part.end - 1);
        }
    }
    places
}

/// The label of each place and its probability, of several contacts that of BA and BB together where they are `alike`.
pub(crate) fn most_likely_labels(places: &[Place], alike: bool) -> Vec<(Label, f64)> {
    let mut trellis = if alike { Trellis::alike() } else { Trellis::default() };
    trellis.run(&[0.0; 5], places.iter().map(|place| place.observation)).to_vec()
}

/// Log of the likelihood of the most likely labels.
pub(crate) fn label_log_likelihood(places: &[Place]) -> f64 {
    let last = places.iter().fold([0.0; 5], |before, place| viterbi_step(&before, &place.observation).0);
    last.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// The phases of a scan with these places.
pub(crate) fn identify_phases<I: Inverse>(rod: &I, track: &Track, noise: &Noise, places: Vec<Place>) -> ScanPhases {
    let labels = most_likely_labels(&places, !rod.tells_last());
    let runs = runs(rod, track, noise, &places, &labels);
    ScanPhases { places, runs, labels }
}

/// Runs of one label. They end at breaks, or, between A and B, at the border that fits the samples best.
fn runs<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    places: &[Place],
    labels: &[(Label, f64)],
) -> Vec<(Range<usize>, Label)> {
    let mut runs: Vec<(Range<usize>, Label)> = Vec::new();
    let mut start = 0;
    for k in 1..places.len() {
        let (before, after) = (labels[k - 1].0, labels[k].0);
        if before == after {
            continue;
        }
        let border = match places[k].observation.between {
            Some(here) => here.index,
            None => {
                // the window of the fit may reach across the border: search beyond the two places
                let reach = places[k].fit.window.len();
                let from = places[k - 1].index.saturating_sub(reach).max(start);
                let to = (places[k].index + reach).min(track.tau.len());
                let stop = places[k..]
                    .iter()
                    .find(|place| place.observation.between.is_some())
                    .map_or(to, |place| place.index);
                border(rod, track, noise, from..to.min(stop), before == Label::A)
            }
        };
        runs.push((start..border, before));
        start = border;
    }
    let last = labels.last().map_or(Label::Free, |label| label.0);
    runs.push((start..track.tau.len(), last));
    runs
}
