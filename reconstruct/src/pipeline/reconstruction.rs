//! A whole scan: labels, contact points, and where there are none, why.

use crate::contour::{Assembly, ContourEstimate, Measured};
use crate::kink::{Kink, KinkKind, KinkOptions, find_kinks};
use crate::phase::contact::contact;
use crate::phase::label::Label;
use crate::phase::{Break, Evidence, Identified, identify};
use crate::point::single::NoContact;
use crate::point::touch::Touch;
use crate::scan::local_cubic::Noise;
use crate::scan::noise_estimate::{ChannelNoise, estimate};
use crate::scan::track::{Fault, Track};
use crate::two_contacts::{Limits, Neighbour, Piece, Unresolved, resolve};
use rod_core::{Rod, Sample, Units};
use std::ops::Range;

/// Fewest usable samples of a scan.
const FEWEST: usize = 20;
/// Samples at the borders of phases that may belong to the other side, besides how uncertain the kink there is: in its
/// standard deviations, which are on the small side.
const MARGIN: usize = 3;
const SIGMAS: f64 = 4.0;
/// A kink within a phase is one from this chi^2 on.
const SURE: f64 = 60.0;
/// How many times as many are left out where no contacts agree with what is left.
const MARGINS: [usize; 2] = [3, 10];
/// Largest standard deviation of one of several contacts across the contour, in lengths of the rod.
const ACROSS: f64 = 5e-3;

/// Independent numbers that a stretch with several contacts is described by, about: as many parts of it are independent.
const SERIES: usize = 8;

/// How a scan is reconstructed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Noise of f0x, f0y (N) and m0z (N m), where it is known better than from the scan itself.
    pub noise: Option<[ChannelNoise; 3]>,
    /// False alarms per scan that the search for kinks may give.
    pub false_alarms: f64,
    /// Largest standard deviation of a contact point across the contour, in lengths of the rod: beyond, there is none.
    pub largest_sigma: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { noise: None, false_alarms: KinkOptions::default().false_alarms, largest_sigma: 0.02 }
    }
}

/// Why a scan cannot be reconstructed at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReconstructError {
    /// Too few samples.
    #[error(
        "{usable} usable samples of {samples}, expected at least {fewest}: along one path, each beyond the one before"
    )]
    TooFew {
        /// How many there are of use.
        usable: usize,
        /// How many there are.
        samples: usize,
        /// The least number.
        fewest: usize,
    },
    /// A setting that is none.
    #[error("{what} is {value}, expected a positive, finite number")]
    Setting {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Why there is no contact point.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The rod touches nothing.
    #[error("the rod is free")]
    Free,
    /// The sample is of no use.
    #[error("{0}")]
    Fault(#[from] Fault),
    /// No single contact fits, though the label says there is one.
    #[error("{0}")]
    NoContact(#[from] NoContact),
    /// The point is known no better than this, m.
    #[error("the point is uncertain by {sigma:.1e} m")]
    TooNoisy {
        /// Standard deviation across the contour (or along it, where that is what is too large), m.
        sigma: f64,
    },
    /// Several contacts are resolved from a whole scan only.
    #[error("several contacts, which are resolved from the whole scan only")]
    Live,
    /// Of several contacts this one is not resolved.
    #[error("several contacts: {0}")]
    Several(#[from] Unresolved),
}

/// The answer to one sample, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The phase.
    pub label: Label,
    /// By how much the probability of the label exceeds that of the next best one, 0 to 1.
    pub margin: f64,
    /// The contact, or the first of several.
    pub touch: Result<Touch, Reason>,
    /// The second of several; none where the label is of a single contact or none.
    pub second: Option<Result<Touch, Reason>>,
    /// Where its evidence is.
    pub(crate) place: usize,
}

impl Reading {
    /// A sample of this label that has no contact point.
    pub(crate) fn without(label: Label, reason: Reason) -> Self {
        Self { label, margin: 0.0, touch: Err(reason), second: None, place: usize::MAX }
    }
}

/// What a scan says of the object.
#[derive(Clone, Debug)]
pub struct Reconstruction {
    /// One a sample, in order.
    pub readings: Vec<Reading>,
    /// Runs of samples with one label: the number of the first sample, and the label.
    pub runs: Vec<(usize, Label)>,
    /// Kinks and jumps of the reactions: number of the first sample after each.
    pub kinks: Vec<Kink>,
    /// Noise of f0x, f0y (N) and m0z (N m) that was found or given.
    pub noise: [ChannelNoise; 3],
    evidence: Vec<Evidence>,
    /// Samples of each place's window; none of single samples that were taken as they are.
    windows: Vec<usize>,
}

impl Reconstruction {
    /// The contour: contact points assembled into stretches, and the gaps between them.
    ///
    /// In noise the points of neighbouring samples come from fits that overlap. Each is counted for its part of the
    /// window, so that the standard deviations of the contour are what the noise of the samples makes of them.
    pub fn contour(&self, assembly: &Assembly) -> ContourEstimate {
        let runs = self.runs.iter().map(|run| run.0).skip(1).chain([self.readings.len()]);
        let mut lengths = self.runs.iter().zip(runs).map(|(run, end)| (end, end - run.0));
        let mut run = lengths.next();
        let mut touches: Vec<Touch> = Vec::with_capacity(self.readings.len());
        let answers: Vec<(Range<usize>, Option<String>, usize)> = self
            .readings
            .iter()
            .enumerate()
            .map(|(sample, reading)| {
                while run.is_some_and(|(end, _)| end <= sample) {
                    run = lengths.next();
                }
                let window = match reading.second {
                    Some(_) => run.map_or(1, |(_, length)| length / SERIES),
                    None => self.windows.get(reading.place).copied().unwrap_or(1),
                };
                // of several contacts the second counts only after the first
                let second = reading.second.filter(|_| reading.touch.is_ok());
                let start = touches.len();
                touches.extend(std::iter::once(reading.touch).chain(second).filter_map(Result::ok));
                let reason = reading.touch.err().filter(|reason| *reason != Reason::Free);
                (start..touches.len(), reason.map(|reason| reason.to_string()), window)
            })
            .collect();
        assembly.assemble(self.readings.iter().zip(&answers).map(|(reading, (range, reason, shared))| Measured {
            reason: reason.as_deref(),
            shared: *shared,
            ..Measured::new(reading.label, &touches[range.clone()])
        }))
    }

    /// The criteria about a sample, dimensionless; none for one that is of no use.
    pub fn evidence(&self, sample: usize) -> Option<&Evidence> {
        self.readings.get(sample).and_then(|reading| self.evidence.get(reading.place))
    }
}

/// Tells from the reactions of a scan alone in which phase each sample was and where the rod touched the object. The samples
/// go along one path of the clamp; those that are no numbers, repeat a pose or turn back are left out, with the reason.
///
/// Kinks and jumps cut the scan into parts; in each, local cubics give reactions and their rates with covariance; the
/// criteria from them (phase criterion, length, tangent: see [`Evidence`]) and the phase diagram of Merker et al. (2020,
/// fig. 8b) give the labels; single contacts follow in closed form, several by the envelope of the scan.
///
/// Accuracy: of noise-free samples single contact points are exact to 1e-11 of the rod's length. In noise, each comes with
/// its covariance.
///
/// # Errors
/// [`ReconstructError`].
pub fn reconstruct(rod: &Rod, samples: &[Sample], settings: &Settings) -> Result<Reconstruction, ReconstructError> {
    positive([("false_alarms", settings.false_alarms), ("largest_sigma", settings.largest_sigma)])?;
    let units = rod.units();
    let (track, places) = Track::new(rod, samples);
    if track.len() < FEWEST {
        return Err(ReconstructError::TooFew { usable: track.len(), samples: samples.len(), fewest: FEWEST });
    }
    let channels = [0, 1, 2].map(|c| track.clamps.iter().map(|clamp| clamp.reactions[c]).collect::<Vec<f64>>());
    let size = [units.force, units.force, units.moment];
    let found = match settings.noise {
        Some(noise) => dimensionless(&noise, units),
        None => noise_of(&track, &channels, samples, size),
    };
    let [f0x, f0y, m0z] = &channels;
    let options = KinkOptions { false_alarms: settings.false_alarms, ..KinkOptions::default() };
    let kinks = find_kinks(&track.tau, [f0x, f0y, m0z], &found, options);
    let noise = Noise::new(&found);
    let breaks: Vec<Break> = kinks
        .iter()
        .map(|kink| Break { index: kink.next, jump: kink.kind == KinkKind::Jump, score: kink.score })
        .collect();
    let identified = identify(&track, &noise, &breaks);
    let usable =
        Answers { track: &track, kinks: &kinks, noise: &noise, identified: &identified, units, settings }.all(&breaks);

    let mut numbers = Vec::with_capacity(track.len());
    let mut readings = Vec::with_capacity(samples.len());
    for (number, place) in places.iter().enumerate() {
        match place {
            Ok(index) => {
                numbers.push(number);
                readings.push(usable[*index]);
            }
            Err(fault) => {
                let label = readings.last().map_or(Label::Free, |before: &Reading| before.label);
                readings.push(Reading::without(label, Reason::Fault(*fault)));
            }
        }
    }
    let runs =
        identified.runs.iter().filter(|run| !run.0.is_empty()).map(|run| (numbers[run.0.start], run.1)).collect();
    let slope = |kink: &Kink, c: usize| if kink.kind == KinkKind::Kink { size[c] / units.length } else { size[c] };
    let in_units = |kink: &Kink| Kink {
        tau: kink.tau * units.length,
        sigma_tau: kink.sigma_tau * units.length,
        next: numbers[kink.next.min(numbers.len() - 1)],
        change: std::array::from_fn(|c| kink.change[c] * slope(kink, c)),
        sigma: std::array::from_fn(|c| kink.sigma[c] * slope(kink, c)),
        ..*kink
    };
    let clean = noise.is_clean();
    Ok(Reconstruction {
        readings,
        runs,
        kinks: kinks.iter().map(in_units).collect(),
        noise: std::array::from_fn(|c| ChannelNoise { sigma: found[c].sigma * size[c], ..found[c] }),
        windows: identified.nodes.iter().map(|node| if clean { 1 } else { node.fit.window.len() }).collect(),
        evidence: identified.nodes.into_iter().map(|node| node.evidence).collect(),
    })
}

/// Noise in SI units made dimensionless.
pub(crate) fn dimensionless(noise: &[ChannelNoise; 3], units: Units) -> [ChannelNoise; 3] {
    let size = [units.force, units.force, units.moment];
    std::array::from_fn(|c| ChannelNoise { sigma: noise[c].sigma / size[c], ..noise[c] })
}

/// Settings that must be positive, finite numbers.
pub(crate) fn positive(settings: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ReconstructError> {
    match settings.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some((what, value)) => Err(ReconstructError::Setting { what, value }),
        None => Ok(()),
    }
}

/// The noise of the samples: what the sensor says of itself, where it does, with the correlation that the scan shows.
fn noise_of(track: &Track, channels: &[Vec<f64>; 3], samples: &[Sample], size: [f64; 3]) -> [ChannelNoise; 3] {
    let told: Option<Vec<_>> = samples.iter().map(|sample| sample.sigma).collect();
    std::array::from_fn(|c| {
        let found = estimate(&track.tau, &channels[c]);
        let told = told.as_ref().filter(|told| !told.is_empty()).map(|told| {
            let squares =
                told.iter().map(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z][c].powi(2)).filter(|v| v.is_finite());
            (squares.sum::<f64>() / told.len() as f64).sqrt() / size[c]
        });
        ChannelNoise { sigma: told.unwrap_or(found.sigma), ..found }
    })
}

/// The point in SI units, if it is known well enough.
pub(crate) fn sure(touch: Touch, units: Units, largest_sigma: f64) -> Result<Touch, Reason> {
    let sigma = touch.sigma_normal();
    if sigma <= largest_sigma {
        Ok(touch.in_units(units))
    } else {
        Err(Reason::TooNoisy { sigma: sigma * units.length })
    }
}

/// Whether the reactions jump before this sample.
fn jumps(breaks: &[Break], index: usize) -> bool {
    breaks.iter().any(|here| here.jump && here.index == index)
}

struct Answers<'a> {
    track: &'a Track,
    kinks: &'a [Kink],
    noise: &'a Noise,
    identified: &'a Identified,
    units: Units,
    settings: &'a Settings,
}

impl Answers<'_> {
    /// The answers to all usable samples.
    fn all(&self, breaks: &[Break]) -> Vec<Reading> {
        let mut readings = Vec::with_capacity(self.track.len());
        let runs = &self.identified.runs;
        let mut next = 0;
        while next < runs.len() {
            if runs[next].1.several() {
                let many = runs[next..].iter().take_while(|run| run.1.several()).count();
                self.several(next..next + many, breaks, &mut readings);
                next += many;
            } else {
                let (range, label) = runs[next].clone();
                let mut nodes = Nearest::new(self, label, range.start);
                readings.extend(range.map(|index| self.single(&mut nodes, index, label)));
                next += 1;
            }
        }
        readings
    }

    fn reading(&self, nodes: &mut Nearest<'_>, index: usize, label: Label, touch: Result<Touch, Reason>) -> Reading {
        let place = nodes.of(index);
        let margin = match self.identified.labels[place] {
            (found, margin) if found == label => margin,
            _ => 0.0,
        };
        Reading { label, margin, touch, second: None, place }
    }

    fn single(&self, nodes: &mut Nearest<'_>, index: usize, label: Label) -> Reading {
        if label == Label::Free {
            return self.reading(nodes, index, label, Err(Reason::Free));
        }
        let fit = &self.identified.nodes[nodes.of(index)].fit;
        let touch = contact(&self.track.clamps[index], self.track.tau[index], fit, self.noise, label);
        let touch = touch.map_err(Reason::NoContact).and_then(|touch| self.sure(touch));
        self.reading(nodes, index, label, touch)
    }

    /// The point in SI units, if it is known well enough.
    fn sure(&self, touch: Touch) -> Result<Touch, Reason> {
        sure(touch, self.units, self.settings.largest_sigma)
    }

    /// By how many samples a border may be misplaced: as far as its kink may be.
    fn unsure(&self, border: usize) -> usize {
        let track = self.track;
        let kink = self.kinks.iter().find(|kink| kink.next == border);
        let sigma = kink.map_or(0.0, |kink| SIGMAS * kink.sigma_tau);
        let from = track.tau.get(border).map_or(border, |tau| track.tau.partition_point(|other| *other < tau - sigma));
        (border - from.min(border)).min(track.len())
    }

    /// A series of runs with several contacts: resolved in parts between jumps and between kinks within a phase, where
    /// other contacts than those before may be the first and the last.
    fn several(&self, series: Range<usize>, breaks: &[Break], readings: &mut Vec<Reading>) {
        let runs = &self.identified.runs;
        let single = |label: Label| label != Label::Free && !label.several();
        let neighbour = |index: Option<usize>| {
            let (range, label) = runs.get(index?).filter(|run| single(run.1))?;
            Some(Neighbour { range: range.clone(), label: *label })
        };
        let mut before = neighbour(series.start.checked_sub(1)).filter(|_| !jumps(breaks, runs[series.start].0.start));
        let mut pieces: Vec<Piece> = Vec::new();
        for (range, label) in &runs[series.clone()] {
            let inside =
                breaks.iter().filter(|here| here.score > SURE && range.start < here.index && here.index < range.end);
            let mut start = range.start;
            for end in inside.map(|here| here.index).chain([range.end]) {
                if start > range.start || jumps(breaks, start) && !pieces.is_empty() {
                    self.resolved(std::mem::take(&mut pieces), before.take(), None, readings);
                }
                pieces.push(Piece { range: start..end, label: *label });
                start = end;
            }
        }
        let after = neighbour(Some(series.end)).filter(|_| !jumps(breaks, runs[series.end - 1].0.end));
        self.resolved(pieces, before, after, readings);
    }

    /// Pieces that follow each other smoothly.
    fn resolved(
        &self,
        pieces: Vec<Piece>,
        before: Option<Neighbour>,
        after: Option<Neighbour>,
        readings: &mut Vec<Reading>,
    ) {
        let borders = pieces.iter().flat_map(|piece| [piece.range.start, piece.range.end]);
        let margin = borders.map(|border| self.unsure(border)).max().unwrap_or(0) + MARGIN;
        let limits = Limits { across: self.settings.largest_sigma.min(ACROSS), margin, ..Limits::default() };
        let mut pairs = resolve(self.track, self.noise, &pieces, before.clone(), after.clone(), &limits);
        for wider in MARGINS {
            // a border misplaced by more than its kink tells spoils all: leave out more
            if self.noise.is_clean() || pairs.iter().any(|pair| pair.first.is_ok()) {
                break;
            }
            let limits = Limits { margin: margin * wider, ..limits };
            pairs = resolve(self.track, self.noise, &pieces, before.clone(), after.clone(), &limits);
        }
        let sure = |found: Result<Touch, Unresolved>| match found {
            Ok(touch) => self.sure(touch),
            Err(Unresolved::TooNoisy { sigma }) => Err(Reason::TooNoisy { sigma: sigma * self.units.length }),
            Err(reason) => Err(Reason::Several(reason)),
        };
        let mut pairs = pairs.into_iter();
        for Piece { range, label } in pieces {
            let mut nodes = Nearest::new(self, label, range.start);
            for (index, pair) in range.zip(pairs.by_ref()) {
                let reading = self.reading(&mut nodes, index, label, sure(pair.first));
                readings.push(Reading { second: Some(sure(pair.second)), ..reading });
            }
        }
    }
}

/// The nearest place of a label, for samples in order.
struct Nearest<'a> {
    identified: &'a Identified,
    label: Label,
    at: usize,
}

impl<'a> Nearest<'a> {
    /// For samples from `start` on.
    fn new(answers: &Answers<'a>, label: Label, start: usize) -> Self {
        let nodes = &answers.identified.nodes;
        let at = nodes.partition_point(|node| node.index < start).min(nodes.len().saturating_sub(1));
        Self { identified: answers.identified, label, at }
    }

    fn of(&mut self, index: usize) -> usize {
        let (nodes, labels) = (&self.identified.nodes, &self.identified.labels);
        let off = |at: usize| (labels[at].0 != self.label, nodes[at].index.abs_diff(index));
        // Places of other labels may lie between: go on as long as it gets nearer.
        let mut look = self.at;
        while look + 1 < nodes.len() && nodes[look].index <= index {
            look += 1;
            if off(look) < off(self.at) {
                self.at = look;
            }
        }
        self.at
    }
}
