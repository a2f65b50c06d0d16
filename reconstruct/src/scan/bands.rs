//! The power of a channel's noise at longer and longer times, where it may exceed that of neighbouring samples: drift, low-pass
//! filters, hum.
//!
//! Samples are averaged in blocks of 1, 2, 4, ... samples (levels). Windows of 16 blocks give the power of the Legendre terms of
//! degree 6 and 7, that is, of periods of about 5 blocks. A smooth signal has little of these terms in short windows, and its
//! share grows with the 13th power of the window's length; that of noise grows more slowly (a random walk: with the square).

use super::polynomials::Bases;
use super::quantum::{hold_length, quantum};
use crate::numeric::dot;

/// Blocks of a window. Larger: the power is that of longer times, so that more of the signal is left in it.
const BLOCKS: usize = 16;
/// Polynomials up to degree 7.
const COLUMNS: usize = 8;
/// The terms whose power is taken. Higher: less signal, and shorter times.
const TAKEN: [usize; 2] = [6, 7];
/// Fewest windows of a level. Fewer: the power at longer times is known, but a few kinks are taken for noise.
const FEWEST_WINDOWS: usize = 24;
/// The power of a level is this quantile of the windows, and the same quantile of a chi-squared variable of two degrees of freedom
/// (2 ln 4). Larger: noise in a part of the recording counts for the whole, and so do kinks.
const QUANTILE: (f64, f64) = (0.75, 2.772_588_722_239_781);
/// Largest growth of the power from one level to the next that is noise. A random walk has 4. Larger: more of the signal is taken
/// for noise, and weak kinks beside curved signals are missed.
const GROWTH: f64 = 6.0;
/// Growth of the power of a random walk, with which rising noise goes on at most.
const WALK: f64 = 4.0;
/// The power rises in noise by this factor at least, or it does not rise. Smaller: the uncertainty of the estimate counts as a rise.
const RISES: f64 = 1.4;
/// Power that falls again at longer times by more than this factor is hum: the power of a signal does not fall.
const FALLS: f64 = 2.0;

/// Power of the noise at each level: the variance of white noise of the samples that has the same power there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bands {
    power: Vec<f64>,
    /// Relative standard deviation of the power of each level.
    spread: Vec<f64>,
    /// Factor from the last level to longer times, per level.
    growth: f64,
}

impl Bands {
    /// Of a channel sampled at `tau`. Windows with values that are not finite are left out.
    fn smooth(tau: &[f64], channel: &[f64], known: f64) -> Self {
        let (mut tau, mut channel) = (tau.to_vec(), channel.to_vec());
        let (mut power, mut spread) = (Vec::new(), Vec::new());
        let mut squares = Vec::with_capacity(tau.len() / BLOCKS);
        let mut size = 1.0;
        while tau.len() >= FEWEST_WINDOWS * BLOCKS {
            windows(&tau, &channel, &mut squares);
            let Some(found) = quantile(&mut squares) else { break };
            power.push(size * found);
            spread.push(1.5 / (squares.len() as f64).sqrt());
            halve(&mut tau);
            halve(&mut channel);
            size *= 2.0;
        }
        let growth = without_signal(&mut power, known);
        Self { power, spread, growth }
    }

    /// Of a channel, and of its steps if it has few digits. `known` is the power of the noise of neighbouring samples.
    pub fn of(tau: &[f64], channel: &[f64], known: f64) -> Self {
        let bands = Self::smooth(tau, channel, known);
        match quantum(channel) {
            Some(step) => bands.with_steps(step, hold_length(channel)),
            None => bands,
        }
    }

    /// With the power of steps of this size, where values are held for about `hold` samples: the error of a sample is uniform over the
    /// step, and means of fewer samples do not reduce it.
    fn with_steps(mut self, step: f64, hold: usize) -> Self {
        let variance = step * step / 12.0;
        for (level, power) in self.power.iter_mut().enumerate() {
            *power = power.max(variance * 2.0_f64.powi(level as i32).min(hold.max(1) as f64));
        }
        self
    }

    /// Number of levels that were measured.
    pub fn levels(&self) -> usize {
        self.power.len()
    }

    /// The power at a level, extrapolated where it was not measured.
    pub fn at(&self, level: usize) -> f64 {
        let Some(last) = self.power.last() else { return 0.0 };
        let beyond = (level + 1).saturating_sub(self.power.len());
        self.power.get(level).copied().unwrap_or(last * self.growth.powi(beyond.min(64) as i32))
    }

    /// The power at a level over a known one: 1 unless it is larger by more than the estimate's uncertainty.
    pub fn excess(&self, level: usize, known: f64) -> f64 {
        let Some(spread) = self.spread.get(level).or(self.spread.last()) else { return 1.0 };
        let ratio = self.at(level) / known;
        if ratio.is_finite() && ratio > RISES.max(1.0 + 4.0 * spread) { ratio } else { 1.0 }
    }
}

/// Sums of squares of the terms taken, of each window.
fn windows(tau: &[f64], channel: &[f64], squares: &mut Vec<f64>) {
    squares.clear();
    let mut bases = Bases::<COLUMNS>::new(BLOCKS);
    let mut values = [0.0; BLOCKS];
    for (tau, channel) in tau.chunks_exact(BLOCKS).zip(channel.chunks_exact(BLOCKS)) {
        let basis = bases.at(tau);
        // terms of high degree of large values would be rounding
        let middle = channel[BLOCKS / 2];
        values.iter_mut().zip(channel).for_each(|(v, y)| *v = y - middle);
        let sum: f64 = TAKEN.iter().map(|&k| dot(&values, &basis[k]).powi(2)).sum();
        // a free rod and a coarse quantum leave nothing, which is no measure of the noise elsewhere
        if sum.is_finite() && sum > 0.0 {
            squares.push(sum);
        }
    }
}

/// The variance of a term from the sums of squares.
fn quantile(squares: &mut [f64]) -> Option<f64> {
    if squares.len() < FEWEST_WINDOWS {
        return None;
    }
    let at = (QUANTILE.0 * squares.len() as f64) as usize;
    let (_, found, _) = squares.select_nth_unstable_by(at, f64::total_cmp);
    Some(*found / QUANTILE.1)
}

/// Means of pairs.
fn halve(values: &mut Vec<f64>) {
    let count = values.len() / 2;
    for i in 0..count {
        values[i] = 0.5 * (values[2 * i] + values[2 * i + 1]);
    }
    values.truncate(count);
}

/// Replaces the power of levels that show the signal by what the noise before it lets expect; returns the growth with which the noise
/// goes on beyond the last level.
fn without_signal(power: &mut [f64], known: f64) -> f64 {
    let count = power.len();
    // the least power at this level and all longer times
    let mut least = power.to_vec();
    for k in (1..count).rev() {
        least[k - 1] = least[k - 1].min(least[k]);
    }
    let before = |k: usize| if k == 0 { known } else { least[k - 1] };
    let rise = |k: usize| least[k] / before(k).max(f64::MIN_POSITIVE);
    let rises = |k: usize| rise(k) > RISES;
    // a signal rises without end once it has risen out of the noise
    let mut end = (0..count).find(|&k| rise(k) > GROWTH).unwrap_or(count);
    let mut growth = 1.0;
    if end > 0 && rises(end - 1) {
        if end > 1 && rises(end - 2) {
            growth = rise(end - 2).min(WALK);
        }
        // the last level may show some of the signal
        end -= 1;
    }
    let mut steady = known;
    for k in 0..count {
        steady = if k < end { least[k] } else { (steady * growth).min(least[k]) };
        let hum = power[k] > FALLS * least[k];
        power[k] = if hum { power[k] } else { steady };
    }
    growth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;

    const COUNT: usize = 60_000;

    fn bands(noise: impl Fn(&mut Random, f64) -> f64, bend: f64) -> Bands {
        let mut random = Random::new(3);
        let tau: Vec<f64> = (0..COUNT).map(|i| 1.7 * i as f64 / COUNT as f64).collect();
        let mut state = 0.0;
        let channel: Vec<f64> = tau
            .iter()
            .map(|t| {
                state = noise(&mut random, state);
                state + bend * (5.0 * t).sin() + bend * (t - 0.8).max(0.0)
            })
            .collect();
        Bands::smooth(&tau, &channel, 1.0)
    }

    #[test]
    fn white_noise_is_flat_whatever_the_signal() {
        for bend in [0.0, 1.0, 1e3, 1e6] {
            let found = bands(|random, _| random.normal(), bend);
            let excess = (0..16).map(|level| found.excess(level, 1.0)).fold(1.0, f64::max);
            assert!(excess == 1.0, "{bend} {found:?}");
        }
    }

    #[test]
    fn a_walk_rises_by_four_and_correlated_noise_to_its_long_run() {
        let walk = bands(|random, state| state + random.normal(), 10.0);
        assert!((6..8).all(|k| (2.5..6.0).contains(&(walk.at(k + 1) / walk.at(k)))), "{walk:?}");
        assert!((2.5..=WALK).contains(&walk.growth), "{walk:?}");
        let correlated = bands(|random, state| 0.9 * state + (1.0_f64 - 0.81).sqrt() * random.normal(), 10.0);
        assert!((11.0..25.0).contains(&correlated.at(7)), "{correlated:?}");
    }
}
