//! Single samples that stand out of their neighbours by far more than the noise.

use crate::numeric::robust_sigma;
use rod_core::Sample;

/// Samples of the median on either side.
const BESIDE: usize = 2;
/// Distance from the median of the neighbours, in standard deviations of such distances. Smaller: noise counts as spikes.
const SIGMAS: f64 = 10.0;
/// The same in ranges of the neighbours. Smaller: a peak of exact reactions counts as a spike.
const RANGES: f64 = 2.0;

/// Whether each sample is a spike in one of its reactions.
pub(super) fn spikes(samples: &[Sample]) -> Vec<bool> {
    let mut found = vec![false; samples.len()];
    if samples.len() <= 2 * BESIDE {
        return found;
    }
    let channels: [fn(&Sample) -> f64; 3] = [|s| s.reactions.f0x, |s| s.reactions.f0y, |s| s.reactions.m0z];
    for channel in channels {
        let distances: Vec<(f64, f64)> = (0..samples.len()).map(|k| distance(samples, k, channel)).collect();
        let finite = distances.iter().map(|(off, _)| *off).filter(|off| off.is_finite());
        let sigma = robust_sigma(finite).unwrap_or(f64::INFINITY);
        for (found, (off, range)) in found.iter_mut().zip(distances) {
            *found |= off > SIGMAS * sigma && off > RANGES * range;
        }
    }
    found
}

/// Distance of a sample from the median of its neighbours, and their range; without itself.
fn distance(samples: &[Sample], at: usize, channel: fn(&Sample) -> f64) -> (f64, f64) {
    let from = at.saturating_sub(BESIDE).min(samples.len() - 2 * BESIDE - 1);
    let mut beside = [0.0; 2 * BESIDE];
    let others = (from..=from + 2 * BESIDE).filter(|k| *k != at);
    beside.iter_mut().zip(others).for_each(|(value, k)| *value = channel(&samples[k]));
    beside.sort_unstable_by(f64::total_cmp);
    let median = 0.5 * (beside[BESIDE - 1] + beside[BESIDE]);
    ((channel(&samples[at]) - median).abs(), beside[2 * BESIDE - 1] - beside[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;
    use rod_core::{Pose, Reactions};

    #[test]
    fn a_spike_is_found_and_steps_kinks_and_noise_are_none() {
        let mut random = Random::new(3);
        let pose = |k: usize| Pose { x: 1e-3 * k as f64, y: 0.0, phi: 1.5 };
        for noise in [0.0, 1e-3] {
            let mut samples: Vec<Sample> = (0..2000)
                .map(|k| {
                    let x = 1e-3 * k as f64;
                    let step = if k < 900 { 0.0 } else { 0.3 };
                    let f0x = step + (x - 0.5).abs() + noise * random.normal();
                    Sample::new(pose(k), Reactions { f0x, f0y: x * x, m0z: 0.0 })
                })
                .collect();
            assert!(spikes(&samples).iter().all(|spike| !spike));
            samples[1500].reactions.f0x += 0.1;
            samples[0].reactions.f0y -= 0.1;
            let found: Vec<usize> = (0..2000).filter(|k| spikes(&samples)[*k]).collect();
            assert_eq!(found, [0, 1500]);
        }
    }
}
