//! Phases and contact points sample by sample, a fixed number of samples late.

use crate::kink::{Kink, KinkFilter, KinkKind, KinkOptions};
use crate::phase::contact::contact;
use crate::phase::label::Label;
use crate::phase::{Break, Node, Trellis, forward};
use crate::pipeline::reconstruction::{Reading, Reason, ReconstructError, dimensionless, positive, sure};
use crate::scan::local_cubic::Noise;
use crate::scan::noise_estimate::ChannelNoise;
use crate::scan::track::{Fault, Intake, Track};
use rod_core::{Rod, Sample, Units};
use std::collections::VecDeque;

/// Places to a half-window.
const PLACES: usize = 8;
/// So many places after a place decide on its label, too.
const LAG: usize = 16;
/// Least and most samples of a half-window.
const LEAST: usize = 8;
const MOST: usize = 100_000;
/// Breaks that may become known at once.
const BREAKS: usize = 16;
/// The number of samples that the false alarms are counted on.
const NOMINAL: usize = 100_000;

/// What must be known before the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveSettings {
    /// Noise of f0x, f0y (N) and m0z (N m), as [`noise_estimate::estimate`](crate::noise_estimate::estimate) finds it in
    /// samples of the free rod, or as the sensor's maker tells.
    pub noise: [ChannelNoise; 3],
    /// Way of the clamp from one sample to the next, about, m.
    pub spacing: f64,
    /// Half-window, m: how far to both sides of a sample the reactions are looked at. Twice as wide sees a kink 2.8 times as
    /// small, twice as late.
    pub half_window: f64,
    /// False alarms of the kink filter in 100,000 samples.
    pub false_alarms: f64,
    /// Largest standard deviation of a contact point across the contour, in lengths of the rod.
    pub largest_sigma: f64,
}

/// The identification of [`reconstruct`](crate::reconstruct) as the samples come: the same criteria, kinks and diagram, in
/// windows of fixed length, with what the next [`delay`](Self::delay) samples tell. Several contacts are flagged, not
/// resolved.
///
/// Memory is taken once, in [`new`](Self::new).
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
    /// Samples in memory, and how many came before them.
    track: Track,
    passed: usize,
    breaks: VecDeque<Break>,
    window: Window,
    /// Places whose label is not decided, the oldest first, and the scores of the ways up to them.
    open: VecDeque<Node>,
    before: [f64; 5],
    trellis: Trellis,
    /// Next place, by the number of its sample.
    next: usize,
    /// Places whose label is decided: the one that holds for the next sample to be answered, and those after it.
    decided: VecDeque<(Node, Label, f64)>,
    /// What came in and is not answered yet: numbers of usable samples, and faults in between.
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
    /// How many samples must follow a place.
    ahead: usize,
    delay: usize,
    /// Fewest and most samples in memory.
    kept: usize,
    capacity: usize,
}

impl LiveSettings {
    /// For samples with this noise at this distance (m): half-windows of 1000 samples.
    pub fn new(noise: [ChannelNoise; 3], spacing: f64) -> Self {
        let false_alarms = KinkOptions::default().false_alarms;
        Self { noise, spacing, half_window: 1000.0 * spacing, false_alarms, largest_sigma: 0.02 }
    }
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
        let half = ((settings.half_window / settings.spacing) as usize).clamp(LEAST, MOST);
        let stride = (half / PLACES).max(1);
        // a transition is handed out one a sample: those of one search within as many samples
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

    /// How many usable samples after a sample its answer comes.
    pub fn delay(&self) -> usize {
        self.window.delay
    }

    /// Takes a sample and answers the one that is due, in order. A sample that is of no use is answered in its turn, with its
    /// fault.
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

    /// No more samples come: answers those left, one a call, then none.
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

    fn note(&mut self, kink: Option<Kink>) {
        let Some(kink) = kink else { return };
        if self.breaks.len() == 2 * BREAKS {
            self.breaks.pop_front();
        }
        let here = Break { index: kink.next, jump: kink.kind == KinkKind::Jump, score: kink.score };
        let at = self.breaks.partition_point(|other| other.index < here.index);
        self.breaks.insert(at, here);
    }

    /// Looks at the next place.
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

    /// Settles the label of the oldest open place.
    fn decide(&mut self) {
        let found = self.trellis.run(&self.before, self.open.iter().map(|node| node.place));
        let (Some((label, margin)), Some(node)) = (found.first().copied(), self.open.pop_front()) else { return };
        self.before = forward(&self.before, &node.place).0;
        self.decided.push_back((node, label, margin));
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
        // between two places of different labels the break decides, or else the middle
        let beyond = self.decided.get(1).filter(|(after, ..)| {
            let from = self.decided.front().map_or(0, |place| place.0.index);
            let border = after.place.between.map_or((from + after.index) / 2, |here| here.index);
            index >= border
        });
        let Some((node, label, margin)) = beyond.or_else(|| self.decided.front()) else {
            return Some(Reading::without(self.last, Reason::Fault(Fault::TooFew)));
        };
        self.last = *label;
        let at = index - self.passed;
        let touch = match label {
            Label::Free => Err(Reason::Free),
            Label::A | Label::B => contact(&self.track.clamps[at], self.track.tau[at], &node.fit, &self.noise, *label)
                .map_err(Reason::NoContact)
                .and_then(|touch| sure(touch, self.units, self.largest_sigma)),
            Label::BA | Label::BB => Err(Reason::Live),
        };
        Some(Reading { label: *label, margin: *margin, touch, ..Reading::without(*label, Reason::Free) })
    }
}
