//! The delay between the clocks of a sensor and of its stage, by the physics.
//!
//! The work of the clamp is the change of the elastic energy (see `agreement`). With the clock of the stage shifted by a delay, the work is
//! done at other times. It then differs from the change of the energy wherever the clamp starts, stops, turns back or changes its speed while
//! the rod is in contact. Along a straight line at constant speed the work does not depend on the delay: the object is shifted, and no
//! contradiction remains, but that reactions may not change while the clamp stands (see `standing`).

use super::agreement::{LAG, energy, in_contact, some_rod, work_between};
use super::frame::WORK;
use super::physics::InFrame;
use super::stage_log::StageLog;
use super::standing::Standing;
use super::timed::{Timed, timed_averages};
use vibrissa::{Pose, Rod, Sample};

/// Decrease of the logarithm of the likelihood at the ends of the interval: half the 95 % quantile of chi squared with one degree of freedom.
const DECREASE: f64 = 1.92;
/// Largest share of the squared changes of the energy at times outside the table of the stage, where the clamp is taken to stand. A larger share shows
/// that the clamp moved there, and the table ends too early for an estimate.
const OUTSIDE: f64 = 0.05;
/// Relative error of work and energy that gains, stiffness and length may cause: that of an ordinary laboratory. Smaller: without noise, the error of
/// the averages decides between delays that are alike; larger: intervals become wider than the noise justifies.
const RELATIVE: f64 = 0.02;
/// Delays of a coarse search. More: more time; fewer: a narrow maximum is missed.
const COARSE: usize = 400;
/// The same where the clamp turns, and each delay needs all energies anew.
const COARSE_TURNING: usize = 120;

/// The delays of the stage's clock that agree with the physics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DelayFound {
    /// The delay of the largest likelihood, s.
    pub best: f64,
    /// Ends of the 95 % interval, s.
    pub interval: [f64; 2],
    /// Whether these are bounds by the physics; otherwise the interval ends where the two files have half of the shorter one in common.
    pub is_bounded: [bool; 2],
    /// Width of the interval by work and energy alone, s.
    pub width_by_work: f64,
    /// Concordance of work and energy.
    pub concordance: f64,
}

/// Samples with the poses that the stage has if its clock is delayed.
pub(super) fn joined(sensed: &[Timed], stage: &StageLog, delay: f64) -> Vec<Sample> {
    sensed.iter().map(|(t, reactions)| Sample::new(stage.at(t - delay), *reactions)).collect()
}

/// The delays at which half of the shorter recording is within the other one.
pub(super) fn range(sensor: [f64; 2], stage: [f64; 2]) -> [f64; 2] {
    let half = 0.5 * (sensor[1] - sensor[0]).min(stage[1] - stage[0]);
    [sensor[0] - stage[1] + half, sensor[1] - stage[0] - half]
}

/// The delays that agree with the physics, in the frame and the units of a hypothesis; none where work and energy agree at no delay.
pub(super) fn delay(sensed: &[Timed], stage: &StageLog, frame: &InFrame, rod: Option<&Rod>) -> Option<DelayFound> {
    let (averages, noise) = timed_averages(sensed)?;
    let [least, most] = range([sensed.first()?.0, sensed.last()?.0], stage.span());
    let standing = Standing::new(sensed, stage);
    let stage = stage.in_frame(frame);
    let samples: Vec<Sample> =
        averages.iter().map(|sample| Sample { reactions: frame.reactions(sample.reactions), ..*sample }).collect();
    let search = Search::new(samples, &stage, frame, frame.noise(noise), rod)?;
    let count = if search.turns { COARSE_TURNING } else { COARSE };
    let step = (most - least) / count as f64;
    let coarse: Vec<(f64, f64)> = (0..=count)
        .map(|k| {
            let delay = least + k as f64 * step;
            (delay, search.misfit(delay).sum)
        })
        .collect();
    let may_be = |delay: f64| standing.as_ref().is_none_or(|standing| standing.contradiction(delay).is_none());
    let mut best = coarse.iter().copied().filter(|one| may_be(one.0)).min_by(|a, b| a.1.total_cmp(&b.1))?;
    // golden sections would need one minimum; thirds of the interval around the best are as good as the averages
    let mut around = step;
    for _ in 0..6 {
        let (center, width) = (best.0, around);
        for k in [-3, -2, -1, 1, 2, 3] {
            let delay = (center + f64::from(k) * width / 3.0).clamp(least, most);
            let sum = search.misfit(delay).sum;
            if sum < best.1 && may_be(delay) {
                best = (delay, sum);
            }
        }
        around /= 2.0;
    }
    let found = search.misfit(best.0);
    if found.concordance < WORK || found.outside > OUTSIDE {
        return None;
    }
    // residuals of neighbouring steps share averages
    let count = search.steps() as f64 / LAG as f64;
    let floor = RELATIVE.powi(2) * found.changes;
    let by_work = |sum: f64| 0.5 * count * ((sum + floor) / (found.sum + floor)).ln() <= DECREASE;
    let is_plausible = |delay: f64, sum: f64| by_work(sum) && may_be(delay);
    let fits_work = |one: &(f64, f64)| by_work(one.1);
    let ends = coarse.iter().position(fits_work).zip(coarse.iter().rposition(fits_work));
    let width_by_work = ends.map_or(0.0, |(first, last)| coarse[last].0 - coarse[first].0);
    let first = coarse.iter().position(|one| is_plausible(one.0, one.1));
    let last = coarse.iter().rposition(|one| is_plausible(one.0, one.1));
    let end = |inside: f64, outside: f64| {
        let (mut inside, mut outside) = (inside, outside);
        for _ in 0..16 {
            let middle = 0.5 * (inside + outside);
            if is_plausible(middle, search.misfit(middle).sum) { inside = middle } else { outside = middle }
        }
        0.5 * (inside + outside)
    };
    let low = first.map_or(best.0, |k| coarse[k].0.min(best.0));
    let high = last.map_or(best.0, |k| coarse[k].0.max(best.0));
    let is_bounded = [first != Some(0), last != Some(coarse.len() - 1)];
    let interval = [
        if is_bounded[0] { end(low, low - step) } else { least },
        if is_bounded[1] { end(high, high + step) } else { most },
    ];
    Some(DelayFound { best: best.0, interval, is_bounded, width_by_work, concordance: found.concordance })
}

/// What work and energy are compared with.
struct Search<'a> {
    /// Averages; x is the time.
    samples: Vec<Sample>,
    contact: Vec<bool>,
    stage: &'a StageLog,
    rod: Rod,
    stiffness: f64,
    turns: bool,
    /// Energies where the clamp does not turn.
    energies: Vec<f64>,
    /// Change of the energy in a step to which residuals are limited: the 90 % quantile. Snaps lose energy without work.
    limit: f64,
}

/// How work and energy differ at a delay.
#[derive(Clone, Copy)]
struct Misfit {
    sum: f64,
    concordance: f64,
    /// Sum of the squared changes of the energy, J^2.
    changes: f64,
    /// Share of it outside the table of the stage.
    outside: f64,
}

impl<'a> Search<'a> {
    fn new(
        samples: Vec<Sample>,
        stage: &'a StageLog,
        frame: &InFrame,
        noise: [f64; 2],
        rod: Option<&Rod>,
    ) -> Option<Self> {
        let contact = in_contact(&samples, noise);
        let stiffness = frame.stiffness();
        let rod = some_rod(&samples, stiffness, rod.map(Rod::length))?;
        let phi = stage.rows()[0].1.phi;
        let turns = stage.rows().iter().any(|row| (row.1.phi - phi).abs() > 1e-4);
        let mut search = Self { samples, contact, stage, rod, stiffness, turns, energies: Vec::new(), limit: 0.0 };
        search.energies = search.energies(0.0);
        let energies = &search.energies;
        let mut sizes: Vec<f64> =
            search.pairs().map(|k| (energies[k + LAG] - energies[k]).abs()).filter(|size| *size > 0.0).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        search.limit = *sizes.get(sizes.len() * 9 / 10)?;
        (search.pairs().count() > 4 * LAG).then_some(search)
    }

    /// Steps in contact, by their first average.
    fn pairs(&self) -> impl Iterator<Item = usize> {
        (0..self.samples.len().saturating_sub(LAG)).filter(|k| self.contact[*k] || self.contact[k + LAG])
    }

    fn steps(&self) -> usize {
        self.pairs().count()
    }

    fn energies(&self, delay: f64) -> Vec<f64> {
        let one = |(sample, contact): (&Sample, &bool)| {
            let pose = self.stage.at(sample.pose.x - delay);
            let energy = || energy(&self.rod, &Sample { pose, ..*sample }, self.stiffness);
            if *contact { energy().unwrap_or(0.0) } else { 0.0 }
        };
        self.samples.iter().zip(&self.contact).map(one).collect()
    }

    fn misfit(&self, delay: f64) -> Misfit {
        let turning;
        let energies = if self.turns {
            turning = self.energies(delay);
            &turning
        } else {
            &self.energies
        };
        let poses: Vec<Pose> = self.samples.iter().map(|sample| self.stage.at(sample.pose.x - delay)).collect();
        let work = |k: usize| {
            let reactions = [&self.samples[k].reactions, &self.samples[k + 1].reactions];
            let [x, y, phi] = work_between([poses[k], poses[k + 1]], reactions, [self.contact[k], self.contact[k + 1]]);
            x + y + phi
        };
        let works: Vec<f64> = (0..self.samples.len().saturating_sub(1)).map(work).collect();
        let [from, to] = self.stage.span();
        let (mut sum, mut squares, mut outside, mut changes) = (0.0, 0.0, 0.0, 0.0);
        for k in self.pairs() {
            let work: f64 = works[k..k + LAG].iter().sum();
            let change = energies[k + LAG] - energies[k];
            let limited = |value: f64| value.clamp(-self.limit, self.limit);
            sum += limited(work - change).powi(2);
            squares += limited(work).powi(2) + limited(change).powi(2);
            changes += limited(change).powi(2);
            let [start, end] = [k, k + LAG].map(|k| self.samples[k].pose.x - delay);
            if end < from || start > to {
                outside += limited(change).powi(2);
            }
        }
        let share = |part: f64, all: f64| if all > 0.0 { part / all } else { 0.0 };
        Misfit {
            sum: sum.max(f64::MIN_POSITIVE),
            concordance: 1.0 - share(sum, squares),
            changes,
            outside: share(outside, changes),
        }
    }
}
