//! Phases and contact points sample by sample, a fixed number of samples late.

use super::live_settings::LiveSettings;
use super::reading::{Reading, Reason, sure};
use super::settings::{ReconstructError, positive};
use crate::kink::{Kink, KinkFilter, KinkKind, KinkOptions};
use crate::phase::{Break, Label, Node, Trellis, contact, forward};
use crate::scan::{Fault, Intake, Noise, Track, dimensionless};
use rod_core::{Rod, Sample, Units};
use std::collections::VecDeque;

/// Places per half-window.
const PLACES: usize = 8;
/// Number of places after a place that take part in the decision on its label. Larger: fewer wrong labels, later.
const LAG: usize = 16;
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
    intake: Intake,
    kinks: KinkFilter,
    /// Samples in memory, and the number of samples before them.
    track: Track,
    passed: usize,
    breaks: VecDeque<Break>,
    window: Window,
    /// Places whose label is not decided, the oldest first, and the scores of the sequences up to them.
    open: VecDeque<Node>,
    before: [f64; 5],
    trellis: Trellis,
    /// Next place, by the number of its sample.
    next: usize,
    /// Places whose label is decided: that of the next sample to be answered, and those after it.
    decided: VecDeque<(Node, Label, f64)>,
    /// Samples that are not answered yet: the numbers of usable ones, and the faults of others.
    waiting: VecDeque<Result<usize, Fault>>,
    last: Label,
    ended: bool,
}

/// Lengths, all in samples.
#[derive(Clone, Copy, Debug)]
struct Window {
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
        let window = Window { half, stride, ahead, delay, kept, capacity: 2 * kept };
        let mut track = Track::default();
        track.tau.reserve_exact(window.capacity);
        track.clamps.reserve_exact(window.capacity);
        Ok(Self {
            units,
            noise: Noise::new(&noise),
            largest_sigma: settings.largest_sigma,
            intake: Intake::new(rod),
            kinks,
            track,
            passed: 0,
            breaks: VecDeque::with_capacity(2 * BREAKS),
            window,
            open: VecDeque::with_capacity(2 * LAG),
            before: [0.0; 5],
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
        match self.intake.take(sample) {
            Ok((tau, clamp)) => {
                if self.track.len() == self.window.capacity {
                    let drop = self.window.capacity - self.window.kept;
                    self.track.tau.drain(..drop);
                    self.track.clamps.drain(..drop);
                    self.passed += drop;
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

    /// Usable samples so far.
    fn count(&self) -> usize {
        self.passed + self.track.len()
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
        let (index, Window { half, stride, .. }) = (self.next, self.window);
        self.next += stride;
        let earlier = self.breaks.partition_point(|here| here.index <= index);
        let lower = earlier.checked_sub(1).map_or(0, |last| self.breaks[last].index).max(self.passed);
        let upper = self.breaks.get(earlier).map_or(usize::MAX, |here| here.index).min(self.count());
        let part = lower - self.passed..upper - self.passed;
        let since =
            self.open.back().or_else(|| self.decided.back().map(|place| &place.0)).map_or(0, |node| node.index + 1);
        let between = self.breaks.range(..earlier).filter(|here| here.index >= since);
        let between = between.copied().max_by(|u, v| u.score.total_cmp(&v.score));
        if let Some(node) = Node::about(&self.track, index - self.passed, part, &self.noise, half) {
            let node = Node { index, ..node.placed(stride, between) };
            self.open.push_back(node);
        }
    }

    /// Decides the label of the oldest open place.
    fn decide(&mut self) {
        let found = self.trellis.run(&self.before, self.open.iter().map(|node| node.place));
        let (Some((label, probability)), Some(node)) = (found.first().copied(), self.open.pop_front()) else { return };
        self.before = forward(&self.before, &node.place).0;
        self.decided.push_back((node, label, probability));
    }

    /// The answer to the sample that has waited longest.
    fn answer(&mut self) -> Option<Reading> {
        let index = match self.waiting.pop_front()? {
            Ok(index) => index,
            Err(fault) => return Some(Reading::without(self.last, Reason::Fault(fault))),
        };
        while self.decided.get(1).is_some_and(|(node, ..)| node.index <= index) {
            self.decided.pop_front();
        }
        // between two places of different labels the border is at the break, or else in the middle
        let beyond = self.decided.get(1).filter(|(after, ..)| {
            let from = self.decided.front().map_or(0, |place| place.0.index);
            let border = after.place.between.map_or((from + after.index) / 2, |here| here.index);
            index >= border
        });
        let Some((node, label, probability)) = beyond.or_else(|| self.decided.front()) else {
            return Some(Reading::without(self.last, Reason::Fault(Fault::TooFew)));
        };
        self.last = *label;
        let at = index - self.passed;
        let touch = match label {
            Label::Free => Err(Reason::Free),
            Label::A | Label::B => contact(&self.track.clamps[at], self.track.tau[at], &node.fit, &self.noise, *label)
                .map_err(Reason::NoContact)
                .and_then(|touch| sure(touch, self.units, self.largest_sigma, false)),
            Label::BA | Label::BB => Err(Reason::Live),
        };
        Some(Reading { label: *label, probability: *probability, touch, ..Reading::without(*label, Reason::Free) })
    }
}
