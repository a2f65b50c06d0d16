//! The search for transitions, from the finest scale to the coarsest.

use super::basis::{BinWindow, FEWEST_BINS, MOST_BINS, ROWS, Verdict, WindowBasis};
use super::candidate::Candidates;
use super::free_knot::{FittedTransition, KnotData};
use super::level::Level;
use super::scale::{KinkOptions, WindowLength, scales};
use super::transition::{Kink, KinkKind};
use crate::numeric::chi_squared::{exceeded_by_six, exceeded_by_three, wilson_hilferty};
use crate::scan::bands::Bands;
use crate::scan::noise_estimate::ChannelNoise;

/// Factor on the thresholds: the variance of the noise is known to about 10 %. Smaller: more false alarms than asked for.
const ALLOWANCE: f64 = 1.1;
/// A kink must fit better than a quartic by at least this much, in units of the noise variance, and by this share of its own score.
/// An ideal kink fits better by a quarter of its score. Larger: weak kinks beside curved signals are missed.
const MARGIN: (f64, f64) = (2.0, 0.1);
/// Largest factor by which thresholds rise with the misfit of a window. Where the misfit stands in for the noise, the score follows
/// an F distribution of few degrees of freedom, with heavier tails: at 11 degrees and a chance of 1e-7 the factor is 6.
const MISFIT: f64 = 6.0;
/// A candidate is rejected where half the window should have found it at this multiple of its threshold but did not: the signal is
/// smooth there.
const MISSED: f64 = 4.0;
/// A transition is a jump where that fits better than a kink by this much, in units of the noise variance. The jump has three more
/// degrees of freedom, which exceed this by chance about once in a million times.
const JUMP: f64 = 32.0;
/// Levels by which the bins that place a knot are finer than those that found it.
const FINER: usize = 3;
/// Largest number of searches of a recording. A search follows another where a transition was dropped in it.
const ROUNDS: usize = 3;
/// A longer window is used if its knot agrees with those of all shorter ones within this many of their standard deviations. Larger:
/// smaller errors from noise, and larger ones from the curvature beside a kink.
const AGREES: f64 = 1.0;
/// Samples within this many standard deviations of a kink belong to neither side.
const GUARD: f64 = 4.0;
/// Standard normal quantile of 95 %: residuals of noise are below it in 95 of 100 windows.
const USUAL: f64 = 1.6449;

/// A transition that was taken.
#[derive(Clone, Copy, Debug)]
struct AcceptedTransition {
    placed: FittedTransition,
    /// Scale that found it.
    scale: usize,
    /// Score over threshold.
    score: f64,
    /// Samples that belong to neither side.
    guard: (usize, usize),
}

/// The search and its memory, which is allocated once for recordings up to a length.
#[derive(Clone, Debug)]
pub(crate) struct Detector {
    options: KinkOptions,
    noise: [ChannelNoise; 3],
    /// White-equivalent noise of a sample.
    sigma: [f64; 3],
    /// Variance of the noise in the bins of each level over that of white noise.
    excess: Vec<[f64; 3]>,
    levels: Vec<Level>,
    scales: Vec<WindowLength>,
    bases: Vec<WindowBasis>,
    taken: Vec<AcceptedTransition>,
    candidates: Candidates,
    /// Scale and sample of the transitions that were taken and dropped again.
    dropped: Vec<(usize, usize)>,
}

/// Numbers of bins that one side of a window may have.
const SIDES: usize = MOST_BINS - FEWEST_BINS + 1;

impl Detector {
    /// For recordings of up to `capacity` samples at distances of about `spacing`.
    pub fn new(capacity: usize, spacing: f64, noise: [ChannelNoise; 3], options: KinkOptions) -> Self {
        let scales: Vec<WindowLength> = scales(spacing, options)
            .filter(|scale| (2 * FEWEST_BINS) << scale.level <= capacity || scale.level == 0)
            .collect();
        let finest = scales.iter().map(|scale| scale.level).max().unwrap_or(0);
        let levels = (0..=finest).map(|level| Level::with_capacity(capacity >> level)).collect();
        let bases = (0..2 * SIDES * SIDES)
            .map(|i| WindowBasis::even(FEWEST_BINS + i / SIDES % SIDES, FEWEST_BINS + i % SIDES, i / (SIDES * SIDES)))
            .collect();
        let (taken, candidates, dropped) = (Vec::new(), Candidates::default(), Vec::new());
        let excess = vec![[1.0; 3]; finest + 1];
        Self { options, noise, sigma: [0.0; 3], excess, levels, scales, bases, taken, candidates, dropped }
    }

    /// With memory for the largest number of transitions, so that no run allocates.
    pub fn roomy(mut self, capacity: usize) -> Self {
        self.candidates.reserve(capacity);
        self.taken.reserve(capacity / 2);
        self.dropped.reserve(ROUNDS * capacity / 2);
        self
    }

    /// Reckons with noise whose power at long times exceeds that of white noise.
    pub fn with_coloured_noise(mut self, tau: &[f64], channels: [&[f64]; 3]) -> Self {
        let sigma = equivalents(&self.noise, channels);
        for (c, channel) in channels.iter().enumerate() {
            let known = sigma[c] * sigma[c];
            let bands = Bands::of(tau, channel, known);
            for (level, excess) in self.excess.iter_mut().enumerate() {
                excess[c] = bands.excess(level, known).max(bands.excess(level + 1, known));
            }
        }
        self
    }

    /// All transitions of a recording in order; `nominal` is the number of samples that the false-alarm rate is for.
    pub fn run(&mut self, tau: &[f64], channels: [&[f64]; 3], nominal: usize) {
        self.taken.clear();
        self.sigma = equivalents(&self.noise, channels);
        self.levels[0].fill(tau, channels, &self.sigma);
        for k in 1..self.levels.len() {
            let (finer, coarser) = self.levels.split_at_mut(k);
            let sigma = self.sigma.map(|s| s / (2.0_f64.powi(k as i32)).sqrt());
            coarser[0].fill_from(&finer[k - 1], &sigma);
        }
        let share = self.options.false_alarms.max(0.0) / self.scales.len() as f64;
        for scale in &mut self.scales {
            let p = share * self.levels[scale.level].size as f64 / nominal.max(1) as f64;
            scale.three = ALLOWANCE * exceeded_by_three(0.5 * p);
            scale.six = ALLOWANCE * exceeded_by_six(0.5 * p);
        }
        self.dropped.clear();
        for _ in 0..ROUNDS {
            let before = self.dropped.len();
            for scale in 0..self.scales.len() {
                self.search(scale);
            }
            self.settle();
            // a misplaced transition may have hidden one that longer windows see
            if self.dropped.len() == before {
                break;
            }
        }
    }

    /// The transitions of the last run, in order.
    pub fn transitions(&self) -> impl Iterator<Item = Kink> + '_ {
        self.taken.iter().map(|taken| Kink::from(*taken))
    }

    /// Takes the best transition of a scale until there is none.
    fn search(&mut self, scale: usize) {
        let WindowLength { level, half, .. } = self.scales[scale];
        self.mask(level);
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        for node in 0..self.levels[level].len() {
            if let Some(ratio) = self.ratio(scale, node)
                && !self.was_dropped(scale, node)
            {
                candidates.push(ratio, node);
            }
        }
        while let Some((ratio, node)) = candidates.pop() {
            let Some(taken) = self.take(scale, node, ratio) else { continue };
            self.levels[level].mask(taken.guard);
            self.taken.push(taken);
            // windows that reached over it are shorter now
            let reach = half + 2;
            candidates.update((node.saturating_sub(2 * reach), node + 2 * reach), |node| self.ratio(scale, node));
        }
        self.candidates = candidates;
    }

    fn was_dropped(&self, scale: usize, node: usize) -> bool {
        let WindowLength { level, half, .. } = self.scales[scale];
        let size = self.levels[level].size;
        self.dropped.iter().any(|(last, next)| scale <= *last && next.abs_diff(node * size) < half * size)
    }

    /// Score over threshold of a node; none where there is no transition.
    fn ratio(&self, scale: usize, node: usize) -> Option<f64> {
        let (verdict, ..) = self.verdict(scale, node, true)?;
        self.passes(scale, &verdict)
    }

    fn passes(&self, scale: usize, verdict: &Verdict) -> Option<f64> {
        let WindowLength { three, six, .. } = self.scales[scale];
        let ratio = (verdict.hinge / three).max(verdict.both / six) / verdict.misfit.min(MISFIT);
        let smooth = verdict.margin < MARGIN.0.max(MARGIN.1 * verdict.both);
        (ratio > 1.0 && !smooth).then_some(ratio)
    }

    fn variance(&self, level: usize) -> [f64; 3] {
        let size = self.levels[level].size as f64;
        std::array::from_fn(|c| self.sigma[c] * self.sigma[c] * self.excess[level][c] / size)
    }

    /// The fit of a window around a node, and the bins of the window. None where there is no room for one and, in a `hurry`, where
    /// noise alone explains the window.
    fn verdict(&self, scale: usize, node: usize, hurry: bool) -> Option<(Verdict, usize, usize)> {
        let WindowLength { level, half, three, six } = self.scales[scale];
        let bins = &self.levels[level];
        let (left, right) = bins.room(node, half);
        let fewest = FEWEST_BINS.max(half / 2);
        if left < fewest || right < fewest || left + right < 7 {
            return None;
        }
        let gap = bins.gap();
        let (from, to) = (node - left, node + gap + right);
        let own;
        let basis = if bins.even(from, to) {
            &self.bases[((gap * SIDES) + left - FEWEST_BINS) * SIDES + right - FEWEST_BINS]
        } else {
            let middle = if gap == 1 { bins.tau[node] } else { 0.5 * (bins.tau[node - 1] + bins.tau[node]) };
            let mut positions = [0.0; ROWS];
            for (position, i) in positions.iter_mut().zip((from..node).chain(node + gap..to)) {
                *position = (bins.tau[i] - middle) / bins.width;
            }
            own = WindowBasis::new(&positions[..left + right], left);
            &own
        };
        let mut window = BinWindow { basis, bins: left + right, y: [[0.0; ROWS]; 3] };
        for (row, y) in window.y.iter_mut().zip(&bins.y) {
            let offset = y[node];
            row[..left].iter_mut().zip(&y[from..node]).for_each(|(row, y)| *row = y - offset);
            row[left..left + right].iter_mut().zip(&y[node + gap..to]).for_each(|(row, y)| *row = y - offset);
        }
        let variance = self.variance(level);
        if hurry {
            let (hinge, both) = window.glance(&variance);
            if !(hinge > three || both > six) {
                return None;
            }
        }
        let verdict = window.judge(&variance, wilson_hilferty(window.bins - 5, USUAL));
        Some((verdict, from, to))
    }

    /// A candidate, placed between samples; none where it does not hold.
    fn take(&self, scale: usize, node: usize, score: f64) -> Option<AcceptedTransition> {
        let (verdict, from, to) = self.verdict(scale, node, false)?;
        let WindowLength { level, .. } = self.scales[scale];
        let bins = &self.levels[level];
        if self.should_have_been_found(scale, node, &verdict) {
            return None;
        }
        let (low, high) = (node.saturating_sub(1) * bins.size, (node + 2) * bins.size);
        let guess = if bins.gap() == 1 { bins.tau[node] } else { 0.5 * (bins.tau[node - 1] + bins.tau[node]) };
        let placed = self.place(level, (from * bins.size, to * bins.size), (low, high), guess)?;
        // a knot that leaves its node belongs to another transition
        if !(low.saturating_sub(bins.size)..=high + bins.size).contains(&placed.next) {
            return None;
        }
        let guard = guard(&placed, &self.levels[0].tau, (to - from) * bins.size / 6);
        Some(AcceptedTransition { placed, scale, score, guard })
    }

    /// The kink, or the jump between samples `near`, of the samples of a window of a level.
    fn place(
        &self,
        level: usize,
        (from, to): (usize, usize),
        near: (usize, usize),
        guess: f64,
    ) -> Option<FittedTransition> {
        let (part, size) = self.part(level);
        let (first, last) = (from / size, to / size);
        let kink = part.kink(first, last, guess).map(|(kink, bent)| (self.with_sample_index(kink), bent));
        let jump = part.jump(first, last, (near.0 / size, near.1.div_ceil(size)));
        let freedom = (3 * (last - first).saturating_sub(5)).max(1) as f64;
        match (kink, jump) {
            (Some((kink, bent)), Some((jump, stepped))) if bent - stepped > JUMP * (stepped / freedom).max(1.0) => {
                // bins do not determine between which samples it jumps
                let near = (jump.next.saturating_sub(2) * size, (jump.next + 2) * size);
                Some(self.part(0).0.jump(from, to, near).map_or(kink, |exact| exact.0))
            }
            (kink, _) => kink.map(|found| found.0),
        }
    }

    /// The bins by which a knot in a window of a level is placed, finer than those of the level, and the samples in each.
    fn part(&self, level: usize) -> (KnotData<'_>, usize) {
        let bins = &self.levels[level.saturating_sub(FINER)];
        let share = (bins.size as f64).sqrt();
        let channels = [&bins.y[0][..], &bins.y[1][..], &bins.y[2][..]];
        let sigma = std::array::from_fn(|c| self.sigma[c] * self.excess[level][c].sqrt() / share);
        (KnotData { tau: &bins.tau, channels, sigma }, bins.size)
    }

    /// A kink that was placed by bins, with the index of the sample after it.
    fn with_sample_index(&self, kink: FittedTransition) -> FittedTransition {
        FittedTransition { next: self.levels[0].tau.partition_point(|t| *t <= kink.tau), ..kink }
    }

    /// Whether half the window would have found this candidate, were it a kink or a jump.
    fn should_have_been_found(&self, scale: usize, node: usize, verdict: &Verdict) -> bool {
        let WindowLength { level, half, .. } = self.scales[scale];
        let (finer, halved) = if level == 0 { (0, half / 2) } else { (level - 1, half) };
        let Some(shorter) = self.scales.iter().find(|s| s.level == finer && s.half == halved) else { return false };
        let ratio = self.levels[finer].width / self.levels[level].width;
        let bins = &self.levels[level];
        let reach = halved * self.levels[finer].size;
        let centre = node * bins.size + bins.size / 2;
        let free = |t: &AcceptedTransition| t.guard.1 + reach <= centre || centre + reach < t.guard.0;
        if centre < reach || centre + reach > self.levels[0].len() || !self.taken.iter().all(free) {
            return false;
        }
        let gap = self.levels[finer].gap();
        let basis = &self.bases[((gap * SIDES) + halved - FEWEST_BINS) * SIDES + halved - FEWEST_BINS];
        let expected: f64 = verdict
            .changes
            .iter()
            .zip(self.variance(finer))
            .map(|([slope, step], variance)| basis.power([slope * ratio, *step]) / variance)
            .sum();
        expected > MISSED * shorter.six
    }

    /// Masks the bins of a level at all transitions.
    fn mask(&mut self, level: usize) {
        let bins = &mut self.levels[level];
        bins.unmask();
        self.taken.iter().for_each(|taken| bins.mask(taken.guard));
    }

    /// Places each transition by the longest window that its neighbours and the noise allow, and drops, weakest first, those that
    /// no longer stand out between their neighbours.
    fn settle(&mut self) {
        self.taken.sort_unstable_by(|a, b| a.placed.tau.total_cmp(&b.placed.tau));
        (0..self.levels.len()).for_each(|level| self.mask(level));
        // twice: a new place changes the windows of the neighbours
        for _ in 0..2 {
            (0..self.taken.len()).for_each(|i| self.settle_one(i));
        }
        while let Some(weakest) = (0..self.taken.len())
            .filter(|i| self.taken[*i].score <= 1.0)
            .min_by(|a, b| self.taken[*a].score.total_cmp(&self.taken[*b].score))
        {
            let dropped = self.taken.remove(weakest);
            self.levels.iter_mut().for_each(|bins| bins.release(dropped.guard));
            self.dropped.push((dropped.scale, dropped.placed.next));
            for i in weakest.saturating_sub(1)..(weakest + 1).min(self.taken.len()) {
                self.settle_one(i);
            }
        }
        self.taken.sort_unstable_by(|a, b| a.placed.tau.total_cmp(&b.placed.tau));
    }

    /// Judges and places a transition again, between its neighbours. Of the windows that the noise allows, a longer one is used if its
    /// knot agrees with those of all shorter ones (Lepski 1990): the curvature may break at a kink, too, and shift the knot of
    /// a long window.
    fn settle_one(&mut self, i: usize) {
        let old = self.taken[i];
        self.levels.iter_mut().for_each(|bins| bins.release(old.guard));
        let mut score = 0.0_f64;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut best: Option<AcceptedTransition> = None;
        for scale in 0..self.scales.len() {
            let level = self.scales[scale].level;
            let bins = &self.levels[level];
            let middle = old.placed.next / bins.size;
            // the fit may have moved the transition into a bin beside the one that found it
            let judged = (middle.saturating_sub(1)..=middle + 1).filter_map(|node| {
                let (verdict, from, to) = self.verdict(scale, node, false)?;
                Some((self.passes(scale, &verdict)?, verdict.misfit, from * bins.size, to * bins.size))
            });
            let Some((ratio, misfit, from, to)) = judged.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            score = score.max(ratio);
            if old.placed.kind == KinkKind::Jump || low > high || (best.is_some() && misfit > 1.0) {
                continue;
            }
            let (part, size) = self.part(level);
            let Some((placed, _)) = part.kink(from / size, to / size, old.placed.tau) else { continue };
            if placed.tau < low || placed.tau > high {
                (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
                continue;
            }
            let placed = self.with_sample_index(placed);
            if placed.next.abs_diff(old.placed.next) > 3 * bins.size {
                continue;
            }
            low = low.max(placed.tau - AGREES * placed.sigma_tau);
            high = high.min(placed.tau + AGREES * placed.sigma_tau);
            let guard = guard(&placed, &self.levels[0].tau, (to - from) / 6);
            if best.is_none_or(|b| placed.sigma_tau < b.placed.sigma_tau) {
                best = Some(AcceptedTransition { placed, guard, ..old });
            }
        }
        let new = AcceptedTransition { score, ..best.unwrap_or(old) };
        self.levels.iter_mut().for_each(|bins| bins.mask(new.guard));
        self.taken[i] = new;
    }
}

/// Samples near a transition that belong to neither side, up to `most` either way.
fn guard(placed: &FittedTransition, tau: &[f64], most: usize) -> (usize, usize) {
    let reach = match placed.kind {
        KinkKind::Kink => GUARD * placed.sigma_tau,
        KinkKind::Jump => 0.0,
    };
    let low = tau.partition_point(|t| *t < placed.tau - reach).max(placed.next.saturating_sub(most));
    let high = tau.partition_point(|t| *t <= placed.tau + reach).min(placed.next + most);
    (low.min(placed.next).saturating_sub(1), high.max(placed.next + 1).min(tau.len()))
}

/// Standard deviation of white noise with the same effect on means, for each channel, and at least the rounding of its largest
/// value. Noise of negative correlation counts as white, because short windows see all of it.
fn equivalents(noise: &[ChannelNoise; 3], channels: [&[f64]; 3]) -> [f64; 3] {
    let mut sigma = [0.0; 3];
    for ((sigma, noise), channel) in sigma.iter_mut().zip(noise).zip(channels) {
        let largest = channel.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        let least = (f64::EPSILON * largest).max(f64::MIN_POSITIVE.sqrt());
        *sigma = (noise.sigma * noise.long_run.max(1.0).sqrt()).max(least);
    }
    sigma
}

impl From<AcceptedTransition> for Kink {
    fn from(taken: AcceptedTransition) -> Self {
        let FittedTransition { kind, tau, sigma_tau, next, change, sigma } = taken.placed;
        let score = change.iter().zip(sigma).map(|(c, s)| (c / s).powi(2)).sum();
        Self { tau, sigma_tau, next, kind, change, sigma, score }
    }
}
