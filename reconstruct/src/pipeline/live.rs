//! Phases and contact points sample by sample, a fixed number of samples late.

use super::learned::Learned;
use super::live_settings::LiveSettings;
use super::reading::{Reading, Reason, sure};
use super::settings::{ReconstructError, positive};
use crate::kink::{Kink, KinkFilter, KinkKind, KinkOptions};
use crate::phase::{Break, Label, Place, Trellis, contact, forward_probabilities, most_likely, viterbi_step};
use crate::scan::{Fault, Noise, SampleScaling, Track, dimensionless};
use rod_core::{Rod, Sample, Uniform, Units};
use std::collections::VecDeque;

/// Places per half-window.
const PLACES: usize = 8;
/// Number of places after a place that take part in the decision on its label. Larger: fewer wrong labels, later.
pub(super) const LAG: usize = 16;
/// Neighbouring places on either side whose windows overlap so much that they do not tell at which of them a phase ends: the border of A
/// and B is off by as much. Larger: labels near a border are less sure than they might be.
const SMEARED: usize = 3;
/// Share of labels that nothing is known of, however sure the criteria are: a break was not found, or wrong errors agree with wrong labels.
/// Measured by `tests/live_labels.rs`.
const MISTAKEN: f64 = 0.02;
/// Fewest samples of a half-window.
const NARROWEST: usize = 8;
/// Most samples of a half-window, which limits the memory.
const WIDEST: usize = 100_000;
/// Largest number of breaks that may be found at once.
const BREAKS: usize = 16;
/// Number of samples for which the false-alarm rate is given.
const NOMINAL: usize = 100_000;

/// [`reconstruct`](crate::reconstruct) sample by sample: the same criteria, kinks and diagram, in windows of fixed length. The answer
/// to a sample comes [`delay`](Self::delay) samples later. Several contacts are recognised, but not resolved.
///
/// All memory is allocated in [`new`](Self::new).
///
/// ```
/// use rod_core::{Pose, Reactions, Rod};
/// use rod_reconstruct::{Label, Live, LiveSettings, Sample, noise_estimate::ChannelNoise};
/// let rod = Rod::new(0.1, 6.3e-4)?;
/// let noise = [1e-3, 1e-3, 2e-5].map(ChannelNoise::white);
/// let settings = LiveSettings { half_window: 1e-3, ..LiveSettings::new(noise, 2e-6) };
/// let mut live = Live::new(&rod, &settings)?;
/// let free = |k: u32| Sample::new(Pose { x: 2e-6 * f64::from(k), y: 0.0, phi: 1.5 }, Reactions::default());
/// let answers: Vec<_> = (0..5000).filter_map(|k| live.push(&free(k))).collect();
/// assert_eq!(answers.len(), 5000 - live.delay());
/// assert!(answers.iter().all(|reading| reading.label == Label::Free));
/// assert_eq!(std::iter::from_fn(|| live.finish()).count(), live.delay());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Live {
    units: Units,
    noise: Noise,
    largest_sigma: f64,
    scaling: SampleScaling,
    kinks: KinkFilter,
    /// Samples in memory, and the number of samples before them.
    track: Track,
    dropped: usize,
    breaks: VecDeque<Break>,
    window: LiveWindow,
    /// Places whose label is not decided, the oldest first, and the scores of the sequences up to them.
    open: VecDeque<Place>,
    before: [f64; 5],
    /// Log of the probability of each label at the last decided place, given the places up to it.
    passed: [f64; 5],
    /// What the scan so far has told of errors that all samples share.
    learned: Option<Learned>,
    trellis: Trellis,
    /// Next place, by the number of its sample.
    next: usize,
    /// Places whose label is decided: that of the next sample to be answered, and those after it.
    decided: VecDeque<Decided>,
    /// Samples that are not answered yet: the numbers of usable ones, and the faults of others.
    waiting: VecDeque<Result<usize, Fault>>,
    last: Label,
    ended: bool,
}

/// A place with its label.
#[derive(Clone, Debug)]
struct Decided {
    place: Place,
    label: Label,
    /// The probability of each label by itself, and that of the label among its neighbours.
    chances: [f64; 5],
    probability: f64,
}

/// Lengths, all in samples.
#[derive(Clone, Copy, Debug)]
struct LiveWindow {
    half: usize,
    /// Distance of places.
    stride: usize,
    /// Number of samples that must follow a place.
    ahead: usize,
    delay: usize,
    /// Fewest and most samples in memory.
    kept: usize,
    capacity: usize,
}

impl Live {
    /// Ready for the first sample.
    ///
    /// # Errors
    /// [`ReconstructError::Setting`].
    pub fn new(rod: &Rod, settings: &LiveSettings) -> Result<Self, ReconstructError> {
        positive([
            ("spacing", settings.spacing),
            ("half_window", settings.half_window),
            ("false_alarms", settings.false_alarms),
            ("largest_sigma", settings.largest_sigma),
        ])?;
        let units = rod.units();
        let noise = dimensionless(&settings.noise, units);
        let options = KinkOptions { false_alarms: settings.false_alarms, widest: settings.half_window / units.length };
        let kinks = KinkFilter::new(settings.spacing / units.length, noise, options, NOMINAL);
        let half = ((settings.half_window / settings.spacing) as usize).clamp(NARROWEST, WIDEST);
        let stride = (half / PLACES).max(1);
        // the filter returns one transition per sample: all of one search within this many samples
        let ahead = half.max(kinks.delay() + BREAKS);
        let delay = ahead + (LAG + 2) * stride;
        let kept = delay + half + stride;
        let window = LiveWindow { half, stride, ahead, delay, kept, capacity: 2 * kept };
        let mut track = Track::default();
        track.tau.reserve_exact(window.capacity);
        track.clamps.reserve_exact(window.capacity);
        Ok(Self {
            units,
            noise: Noise::new(&noise),
            largest_sigma: settings.largest_sigma,
            scaling: SampleScaling::new(rod),
            kinks,
            track,
            dropped: 0,
            breaks: VecDeque::with_capacity(2 * BREAKS),
            window,
            open: VecDeque::with_capacity(2 * LAG),
            before: [0.0; 5],
            passed: [0.0; 5],
            learned: None,
            trellis: Trellis::with_capacity(2 * LAG),
            next: 0,
            decided: VecDeque::with_capacity(window.capacity / stride),
            waiting: VecDeque::with_capacity(window.capacity),
            last: Label::Free,
            ended: false,
        })
    }

    /// Number of usable samples after a sample at which its answer comes.
    pub fn delay(&self) -> usize {
        self.window.delay
    }

    /// Takes a sample and returns the answer that is due. Each sample is answered in its turn; one that cannot be used with its fault.
    pub fn push(&mut self, sample: &Sample) -> Option<Reading> {
        match self.scaling.scale(sample) {
            Ok((tau, clamp)) => {
                if self.track.len() == self.window.capacity {
                    let drop = self.window.capacity - self.window.kept;
                    self.track.tau.drain(..drop);
                    self.track.clamps.drain(..drop);
                    self.dropped += drop;
                }
                self.waiting.push_back(Ok(self.count()));
                self.track.tau.push(tau);
                self.track.clamps.push(clamp);
                let kink = self.kinks.push(tau, clamp.reactions.into());
                self.note(kink);
                while self.next + self.window.ahead < self.count() {
                    self.visit();
                }
                while self.open.len() > LAG {
                    self.decide();
                }
            }
            Err(fault) => self.waiting.push_back(Err(fault)),
        }
        let due = match self.waiting.front()? {
            Ok(index) => index + self.window.delay < self.count(),
            Err(_) => true,
        };
        if due { self.answer() } else { None }
    }

    /// Ends the scan: returns the remaining answers, one per call.
    pub fn finish(&mut self) -> Option<Reading> {
        if !self.ended {
            self.ended = true;
            while let Some(kink) = self.kinks.finish() {
                self.note(Some(kink));
            }
            while self.next < self.count() {
                self.visit();
            }
            while !self.open.is_empty() {
                self.decide();
            }
        }
        self.answer()
    }

    /// The places that are not decided yet, with their path parameters, the oldest first.
    pub(super) fn open(&self) -> impl DoubleEndedIterator<Item = (f64, &Place)> {
        self.open.iter().map(|place| (self.track.tau[place.index - self.dropped], place))
    }

    /// From now on takes off the samples what was learned, and has the rest in its answers. `passed` is the log of the probability of each
    /// label at the last decided place, given the places up to it.
    pub(super) fn learn(&mut self, learned: Learned, passed: [f64; 5]) {
        for place in &mut self.open {
            learned.judge(self.track.tau[place.index - self.dropped], place);
        }
        (self.learned, self.passed) = (Some(learned), passed);
    }

    /// Usable samples so far.
    fn count(&self) -> usize {
        self.dropped + self.track.len()
    }

    /// Keeps a transition, in order.
    fn note(&mut self, kink: Option<Kink>) {
        let Some(kink) = kink else { return };
        if self.breaks.len() == 2 * BREAKS {
            self.breaks.pop_front();
        }
        let here = Break { index: kink.next, jump: kink.kind == KinkKind::Jump, score: kink.score };
        let at = self.breaks.partition_point(|other| other.index < here.index);
        self.breaks.insert(at, here);
    }

    /// Adds the next place.
    fn visit(&mut self) {
        let (index, LiveWindow { half, stride, .. }) = (self.next, self.window);
        self.next += stride;
        let earlier = self.breaks.partition_point(|here| here.index <= index);
        let lower = earlier.checked_sub(1).map_or(0, |last| self.breaks[last].index).max(self.dropped);
        let upper = self.breaks.get(earlier).map_or(usize::MAX, |here| here.index).min(self.count());
        let part = lower - self.dropped..upper - self.dropped;
        let since = self
            .open
            .back()
            .or_else(|| self.decided.back().map(|decided| &decided.place))
            .map_or(0, |place| place.index + 1);
        let between = self.breaks.range(..earlier).filter(|here| here.index >= since);
        let between = between.copied().max_by(|u, v| u.score.total_cmp(&v.score));
        if let Some(place) = Place::about(&Uniform, &self.track, index - self.dropped, part, &self.noise, half) {
            let mut place = Place { index, ..place.in_sequence(stride, between) };
            if let Some(learned) = &self.learned {
                learned.judge(self.track.tau[index - self.dropped], &mut place);
            }
            self.open.push_back(place);
        }
    }

    /// Decides the label of the oldest open place: that of the most likely sequence; with errors that all samples share, the most likely
    /// one by itself.
    fn decide(&mut self) {
        let observations = || self.open.iter().map(|place| place.observation);
        let sequence = match self.learned {
            Some(_) => None,
            None => self.trellis.run(&self.before, observations()).first().copied(),
        };
        let chances = self.trellis.label_probabilities(&self.passed, observations());
        let Some(own) = chances.first().copied() else { return };
        let best = most_likely(&own);
        let label = sequence.map_or(Label::ALL[best], |found| found.0);
        // the windows of neighbouring places overlap: where their labels differ, the border is as uncertain as the windows are wide
        let (mut sum, mut count) = (own[label as usize], 1.0);
        let after = self.open.iter().skip(1).zip(&chances[1..]);
        for (_, chances) in after.take(SMEARED).take_while(|(place, _)| place.observation.between.is_none()) {
            (sum, count) = (sum + chances[label as usize], count + 1.0);
        }
        let starts = self.open.front().is_some_and(|place| place.observation.between.is_some());
        for decided in self.decided.iter().rev().take(if starts { 0 } else { SMEARED }) {
            (sum, count) = (sum + decided.chances[label as usize], count + 1.0);
            if decided.place.observation.between.is_some() {
                break;
            }
        }
        let Some(place) = self.open.pop_front() else { return };
        self.before = viterbi_step(&self.before, &place.observation).0;
        self.passed = forward_probabilities(&self.passed, &place.observation);
        let probability = sequence.map_or((1.0 - MISTAKEN) * sum / count + MISTAKEN / 5.0, |found| found.1);
        self.decided.push_back(Decided { place, label, chances: own, probability });
    }

    /// The answer to the sample that has waited longest.
    fn answer(&mut self) -> Option<Reading> {
        let index = match self.waiting.pop_front()? {
            Ok(index) => index,
            Err(fault) => return Some(Reading::without(self.last, Reason::Fault(fault))),
        };
        while self.decided.get(1).is_some_and(|decided| decided.place.index <= index) {
            self.decided.pop_front();
        }
        // between two places of different labels the border is at the break, or else in the middle
        let beyond = self.decided.get(1).filter(|after| {
            let from = self.decided.front().map_or(0, |decided| decided.place.index);
            let border = after.place.observation.between.map_or((from + after.place.index) / 2, |here| here.index);
            index >= border
        });
        let Some(Decided { place, label, probability, .. }) = beyond.or_else(|| self.decided.front()) else {
            return Some(Reading::without(self.last, Reason::Fault(Fault::TooFew)));
        };
        self.last = *label;
        let at = index - self.dropped;
        let (tau, clamp) = (self.track.tau[at], &self.track.clamps[at]);
        let touch = match (label, &mut self.learned) {
            (Label::Free, _) => Err(Reason::Free),
            (Label::BA | Label::BB, _) => Err(Reason::Live),
            (Label::A | Label::B, None) => contact(&Uniform, clamp, tau, &place.fit, &self.noise, *label)
                .map_err(Reason::NoContact)
                .and_then(|touch| sure(touch, self.units, self.largest_sigma, false)),
            (Label::A | Label::B, Some(learned)) => learned
                .contact(clamp, tau, place, &self.noise, *label)
                .and_then(|touch| sure(touch, learned.units(), self.largest_sigma, self.noise.is_clean())),
        };
        Some(Reading { probability: *probability, touch, ..Reading::without(*label, Reason::Free) })
    }
}
