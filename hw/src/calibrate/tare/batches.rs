//! Means of batches of samples, without keeping the samples.

use core::array::from_fn;
use rod_core::Scalar;

/// Most batches that are kept; twice as many samples to a batch from there on.
const MOST: usize = 64;
/// At the end there are half as many to all of these: long enough for their means to be nearly independent in noise whose
/// neighbours are correlated, many enough for a standard deviation.
const LEAST: usize = 16;

/// Batches of one length, of six values each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Batches {
    means: [Batch; MOST],
    /// How many are complete.
    complete: usize,
    /// Samples in a complete one.
    length: usize,
    /// The one that is being filled, and how many samples are in it.
    current: Batch,
    filled: usize,
}

/// Mean time and mean values of a batch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Batch {
    pub t: f64,
    pub values: [f64; 6],
}

impl Batch {
    fn with(&self, other: &Self, weight: f64) -> Self {
        let mix = |a: f64, b: f64| a + weight * (b - a);
        Self { t: mix(self.t, other.t), values: from_fn(|i| mix(self.values[i], other.values[i])) }
    }
}

impl Batches {
    pub(super) fn new() -> Self {
        Self { means: [Batch::default(); MOST], complete: 0, length: 1, current: Batch::default(), filled: 0 }
    }

    pub(super) fn push(&mut self, t: f64, values: [f64; 6]) {
        self.filled += 1;
        self.current = self.current.with(&Batch { t, values }, 1.0 / self.filled as f64);
        if self.filled < self.length {
            return;
        }
        if let Some(place) = self.means.get_mut(self.complete) {
            *place = self.current;
            self.complete += 1;
        }
        (self.current, self.filled) = (Batch::default(), 0);
        if self.complete == MOST {
            self.halve();
        }
    }

    /// Between 16 and 31 batches, less only where there were less samples. What does not fill one is left out.
    pub(super) fn settled(mut self) -> ([Batch; MOST], usize) {
        while self.complete >= 2 * LEAST {
            self.halve();
        }
        (self.means, self.complete)
    }

    /// Pairs become one.
    fn halve(&mut self) {
        self.complete /= 2;
        self.length *= 2;
        for i in 0..self.complete {
            self.means[i] = self.means[2 * i].with(&self.means[2 * i + 1], 0.5);
        }
    }
}

/// Statistics of one component over the means of batches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Course {
    /// Standard deviation of the mean of all batches.
    pub sigma: f64,
    /// Slope per second, and its standard error.
    pub slope: f64,
    pub slope_sigma: f64,
    /// The stretch of batches that differs most from all others.
    pub change: Change,
    /// Whether the slope leaves less than that does.
    pub steady: bool,
}

/// A stretch of batches that differs from all others: a load that comes and goes, or comes and stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Change {
    /// By how much.
    pub size: f64,
    /// When it begins or, where it is there from the beginning, ends.
    pub t: f64,
    /// How large it is beside the noise of neighbouring batches, in its standard deviations.
    pub deviations: f64,
}

/// Upper quartile of the size of a normal variable.
const QUARTILE: f64 = 1.1503;

impl Course {
    /// Statistics of component `i` over at least three batches.
    pub(super) fn of(batches: &[Batch], i: usize) -> Self {
        let count = batches.len() as f64;
        let values = || batches.iter().map(|b| (b.t, b.values[i]));
        let (mean_t, mean) = values().fold((0.0, 0.0), |(t, v), b| (t + b.0 / count, v + b.1 / count));
        let (mut tt, mut tv, mut vv) = (0.0, 0.0, 0.0);
        for (t, v) in values() {
            tt += (t - mean_t) * (t - mean_t);
            tv += (t - mean_t) * (v - mean);
            vv += (v - mean) * (v - mean);
        }
        let slope = if tt > 0.0 { tv / tt } else { 0.0 };
        let residual = (vv - slope * tv).max(0.0) / (count - 2.0);
        let root = |variance: f64| Scalar::sqrt(variance);
        let (change, explained) = change(batches, i, mean);
        Self {
            sigma: root(vv / (count - 1.0) / count),
            slope,
            slope_sigma: if tt > 0.0 { root(residual / tt) } else { 0.0 },
            change,
            steady: slope * tv >= explained,
        }
    }
}

/// The stretch that explains most of the squares about the mean, and how much of them.
fn change(batches: &[Batch], i: usize, mean: f64) -> (Change, f64) {
    let (count, noise) = (batches.len() as f64, noise(batches, i));
    let (mut found, mut most) = (Change::default(), 0.0);
    for start in 0..batches.len() {
        let mut sum = 0.0;
        for (end, batch) in batches.iter().enumerate().skip(start) {
            sum += batch.values[i] - mean;
            let inside = (end + 1 - start) as f64;
            let outside = count - inside;
            let explained = sum * sum * count / (inside * outside);
            if outside > 0.0 && explained > most {
                let edge = if start > 0 { start } else { end + 1 };
                let t = batches.get(edge).map_or(batch.t, |edge| edge.t);
                let size = sum * count / (inside * outside);
                (found, most) = (Change { size, t, deviations: Scalar::sqrt(explained) / noise }, explained);
            }
        }
    }
    (found, most)
}

/// Standard deviation of a batch, by the upper quartile of the differences of neighbours: the few at steps hardly matter to
/// it, nor does drift.
fn noise(batches: &[Batch], i: usize) -> f64 {
    let mut differences = [0.0; MOST];
    let count = batches.len().saturating_sub(1).min(MOST);
    for (place, pair) in differences.iter_mut().zip(batches.windows(2)) {
        *place = (pair[1].values[i] - pair[0].values[i]).abs();
    }
    let differences = &mut differences[..count];
    differences.sort_unstable_by(f64::total_cmp);
    let quartile = differences.get(3 * count / 4).copied().unwrap_or(0.0);
    quartile / (QUARTILE * core::f64::consts::SQRT_2)
}

#[cfg(test)]
#[allow(clippy::print_stdout, reason = "shares of windows are there to be read")]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Noise of standard deviation 1 whose neighbours are correlated by `rho`.
    fn coloured(rho: f64, seed: u64) -> impl Iterator<Item = f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut generator) };
        let mut state = normal();
        std::iter::from_fn(move || {
            let now = state;
            state = rho * state + (1.0 - rho * rho).sqrt() * normal();
            Some(now)
        })
    }

    /// How far the stretch that differs most does so in noise alone.
    #[test]
    fn changes_of_noise() {
        for (rho, count) in [(0.0, 512), (0.0, 992), (0.46, 512), (0.46, 1000), (0.9, 4000)] {
            let deviations = |seed| {
                let mut batches = Batches::new();
                (0_u32..)
                    .zip(coloured(rho, seed).take(count))
                    .for_each(|(i, y)| batches.push(1e-3 * f64::from(i), [0.0, y, 0.0, 0.0, 0.0, 0.0]));
                let (batches, complete) = batches.settled();
                Course::of(&batches[..complete], 1).change.deviations
            };
            let mut found: Vec<f64> = (0..5000).map(deviations).collect();
            found.sort_by(f64::total_cmp);
            let [median, percent, mille] = [2500, 4950, 4995].map(|i| found[i]);
            println!("AR(1) of {rho}, {count} samples: median {median:.2}, 99 % {percent:.2}, 99.9 % {mille:.2}");
            let beyond = found.iter().filter(|deviations| **deviations > 6.0).count();
            assert!(beyond <= 15, "{beyond} of 5000");
        }
    }
}
