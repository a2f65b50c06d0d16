//! Leaps in a run of contact points: a snap or a slip to another place of the contour within one contact phase.

use super::measured::ContactPoint;
use super::scatter;
use crate::numeric::squared_distance;
use nalgebra::Vector2;

/// Numbers of samples that are averaged before and after a possible leap. Small leaps show in the means of many only.
const SCALES: [usize; 5] = [1, 4, 16, 64, 256];
/// A leap exceeds the motion before and after it by this factor. Smaller: a contact that accelerates smoothly counts as a leap.
const FACTOR: f64 = 4.0;
/// A leap exceeds the motion before and after it by this many standard deviations, which 65,000 samples at five scales do not reach by
/// chance.
const SIGNIFICANCE: f64 = 6.0;
/// Share of a leap that shorter means must show, too, less this many of their standard deviations. A change that is spread over
/// many samples is motion.
const SUDDEN: (f64, f64) = (0.6, 3.0);

/// The indices in a run at which the point has leapt since the point before, in order.
pub(super) fn leaps(run: &[ContactPoint]) -> Vec<usize> {
    let means = Means::new(run);
    let mut found: Vec<usize> = Vec::new();
    for (k, &scale) in SCALES.iter().enumerate().take_while(|&(_, scale)| run.len() >= 3 * scale) {
        let near = |found: &[usize], at: usize| found.iter().any(|&leap| leap.abs_diff(at) < 3 * scale);
        let mut best: Option<(usize, f64)> = None;
        for at in scale..=run.len() - scale {
            let excess = match means.excess(at, k) {
                Some(excess) if !near(&found, at) => excess,
                _ => continue,
            };
            best = match best {
                Some((place, most)) if at - place < 2 * scale => {
                    Some(if excess > most { (at, excess) } else { (place, most) })
                }
                before => {
                    found.extend(before.map(|(place, _)| place));
                    Some((at, excess))
                }
            };
        }
        found.extend(best.map(|(place, _)| place));
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Means over any part of a run.
struct Means<'a> {
    run: &'a [ContactPoint],
    /// Sums of the positions, relative to the first, up to each point.
    sums: Vec<Vector2<f64>>,
    /// Standard deviation of a difference of two means at each scale, relative to that of one point.
    noise: [f64; SCALES.len()],
}

impl<'a> Means<'a> {
    fn new(run: &'a [ContactPoint]) -> Self {
        let origin = run.first().map_or(Vector2::zeros(), |point| point.at);
        let mut sums = vec![Vector2::zeros()];
        let mut sum = Vector2::zeros();
        for point in run {
            sum += point.at - origin;
            sums.push(sum);
        }
        let mut means = Self { run, sums, noise: [0.0; SCALES.len()] };
        means.noise = SCALES.map(|scale| {
            // noise of positive correlation averages out less than white noise
            let blocks = (0..run.len() / scale).map(|block| means.mean(block * scale, (block + 1) * scale));
            let of_block = |block: usize| run[block * scale + scale / 2].covariance / scale as f64;
            let excess = scatter::variance(blocks, of_block).filter(|excess| excess.is_finite()).unwrap_or(1.0);
            (excess.max(1.0) * 2.0 / scale as f64).sqrt()
        });
        means
    }

    fn mean(&self, from: usize, to: usize) -> Vector2<f64> {
        (self.sums[to] - self.sums[from]) / (to - from) as f64
    }

    /// The mean number of the samples of some points: consecutive but for a few.
    fn mean_sample(&self, from: usize, to: usize) -> f64 {
        0.5 * (self.run[from].sample + self.run[to - 1].sample) as f64
    }

    /// How far the mean of the points from `at` on is from that of those before, in standard deviations of the point
    /// `at`.
    fn motion(&self, at: usize, origin: usize, scale: usize) -> Option<f64> {
        if at < scale || at + scale > self.run.len() {
            return None;
        }
        let step = self.mean(at, at + scale) - self.mean(at - scale, at);
        Some(squared_distance(&step, &self.run[origin].covariance).sqrt())
    }

    /// By how much the motion at `at` exceeds that of a contact that moves on steadily; none where it does not.
    fn excess(&self, at: usize, k: usize) -> Option<f64> {
        let scale = SCALES[k];
        let motion = self.motion(at, at, scale)?;
        let chance = SIGNIFICANCE * self.noise[k];
        if motion <= chance {
            return None;
        }
        // samples without an answer between two points lengthen the distance between them
        let span = |at: usize| (self.mean_sample(at, at + scale) - self.mean_sample(at - scale, at)).max(1.0);
        let beside = |beside: usize| self.motion(beside, at, scale).map(|motion| motion * span(at) / span(beside));
        let beside = match (at.checked_sub(2 * scale).and_then(beside), beside(at + 2 * scale)) {
            (Some(a), Some(b)) => a.max(b),
            // near an end of the run one side is missing: there only single steps are compared
            (a, b) if scale == 1 => a.or(b)?,
            _ => return None,
        };
        // less what noise alone contributes
        let beside = (beside * beside - 2.0 * self.noise[k] * self.noise[k]).max(0.0).sqrt();
        let excess = motion - FACTOR * beside - chance;
        let sudden = || {
            (0..k).all(|finer| {
                let seen = self.motion(at, at, SCALES[finer]).unwrap_or(0.0);
                seen >= SUDDEN.0 * motion - SUDDEN.1 * self.noise[finer]
            })
        };
        (excess > 0.0 && sudden()).then_some(excess)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;
    use nalgebra::Matrix2;

    const NONE: [usize; 0] = [];

    /// A run along x at 2 um a sample that leaps after `at` samples.
    fn run(count: usize, at: usize, leap: f64, sigma: f64, seed: u64) -> Vec<ContactPoint> {
        let mut random = Random::new(seed);
        let point = |sample| {
            let x = sample as f64 * 2e-6 + if sample < at { 0.0 } else { leap };
            let at = Vector2::new(x + sigma * random.normal(), sigma * random.normal());
            let covariance = Matrix2::identity() * (sigma * sigma).max(1e-30);
            ContactPoint {
                sample,
                at,
                force: Vector2::x(),
                tangent: Vector2::x(),
                s: f64::INFINITY,
                covariance,
                shared: 1.0,
            }
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn a_leap_is_found_where_it_is_and_nothing_else() {
        for seed in 0..20 {
            assert_eq!(leaps(&run(20_000, 7000, 0.0, 5e-4, seed)), NONE, "{seed}");
            assert_eq!(leaps(&run(20_000, 7000, 2e-2, 5e-4, seed)), [7000], "{seed}");
            let small = leaps(&run(20_000, 7000, 2e-3, 5e-4, seed));
            assert!(small.len() == 1 && small[0].abs_diff(7000) < 16, "{seed} {small:?}");
        }
        assert_eq!(leaps(&run(1000, 400, 1e-5, 0.0, 0)), [400]);
    }

    #[test]
    fn a_contact_that_speeds_up_does_not_leap() {
        // As before a fold: the way grows like a root, here up to the last sample, without noise.
        let mut points = run(5000, 0, 0.0, 0.0, 0);
        for (k, point) in points.iter_mut().enumerate() {
            point.at = Vector2::new(-1e-4 * ((5000 - k) as f64).sqrt(), 0.0);
        }
        assert_eq!(leaps(&points), NONE);
        // Nor one that stands still and goes on.
        for (k, point) in points.iter_mut().enumerate() {
            point.at = Vector2::new(2e-6 * k.saturating_sub(3000) as f64, 0.0);
        }
        assert_eq!(leaps(&points), NONE);
    }

    #[test]
    fn short_runs() {
        for count in 0..6 {
            assert!(leaps(&run(count, 1, 1e-5, 0.0, 0)).len() <= 1);
        }
    }
}
