//! Samples of a sensor that repeats itself: it has lost its connection, or has reached the end of its range.

use super::noise_estimate::estimate;
use super::quantum::usual;
use rod_core::{Reactions, Sample};

/// Fewest equal values in a row that cannot be chance. Where less than a third of all neighbours are equal, chance makes so many in one
/// recording of 1e18.
const FEWEST: usize = 40;
/// Values are repeated that often, as by a sensor that is slower than the recording, times this at most.
const HELD: usize = 8;
/// Largest share of equal neighbours outside of the rows in question. More: the channel has too few digits.
const EQUAL: f64 = 1.0 / 3.0;
/// Smallest noise relative to the largest value. Less: the samples are exact, and a free rod gives equal ones.
const NOISE: f64 = 1e-9;

/// For each sample whether one of its reactions is frozen: it stays exactly the same for many samples, while it is noisy elsewhere.
pub(super) fn frozen(samples: &[Sample]) -> Vec<bool> {
    let mut found = vec![false; samples.len()];
    let channels: [fn(&Reactions) -> f64; 3] = [|r| r.f0x, |r| r.f0y, |r| r.m0z];
    for channel in channels {
        let values: Vec<f64> = samples.iter().map(|sample| channel(&sample.reactions)).collect();
        // without load a sensor without noise shows 0 all the time
        let is_constant = values.windows(2).all(|pair| pair[0] == pair[1]);
        if is_constant && values.len() >= FEWEST && values[0] != 0.0 {
            found.fill(true);
            continue;
        }
        // a sensor that is lost for most of a recording holds one value for all that time
        let least = FEWEST.max(HELD * usual(values.chunk_by(|a, b| a == b).map(<[f64]>::len)));
        let mut start = 0;
        let mut rows = Vec::new();
        for run in values.chunk_by(|a, b| a == b) {
            if run.len() >= least {
                rows.push(start..start + run.len());
            }
            start += run.len();
        }
        if !rows.is_empty() && is_noisy(&values, least) {
            rows.into_iter().for_each(|row| found[row].fill(true));
        }
    }
    found
}

/// Whether a channel has noise of more than its last digit outside of long rows of equal values.
fn is_noisy(values: &[f64], least: usize) -> bool {
    let moving: Vec<f64> = values
        .chunk_by(|a, b| a == b)
        .filter(|run| run.len() < least)
        .flatten()
        .copied()
        .filter(|v| v.is_finite())
        .collect();
    let steps = || moving.windows(2).map(|w| (w[1] - w[0]).abs());
    let equal = steps().filter(|step| *step == 0.0).count();
    let digit = steps().filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let largest = moving.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if equal as f64 > EQUAL * moving.len() as f64 {
        return false;
    }
    let numbers: Vec<f64> = (0..moving.len()).map(|k| k as f64).collect();
    let sigma = estimate(&numbers, &moving).sigma;
    sigma > digit && sigma > NOISE * largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;
    use rod_core::Pose;

    fn rows(of: impl Fn(usize, f64) -> f64) -> Vec<bool> {
        let mut random = Random::new(3);
        let sample = |k| {
            let f0x = of(k, random.normal());
            Sample::new(Pose { x: k as f64, y: 0.0, phi: 0.0 }, Reactions { f0x, f0y: 0.0, m0z: 0.0 })
        };
        frozen(&(0..4000).map(sample).collect::<Vec<_>>())
    }

    /// A contact that comes after a third of the scan.
    fn force(k: usize) -> f64 {
        if k < 1300 { 0.0 } else { (2e-3 * (k - 1300) as f64).sin() }
    }

    #[test]
    fn a_stuck_and_a_saturated_sensor_are_found() {
        let stuck = rows(|k, noise| if (2000..2200).contains(&k) { 0.25 } else { force(k) + 1e-3 * noise });
        assert!((0..4000).all(|k| stuck[k] == (2000..2200).contains(&k)));
        let lost = rows(|k, noise| if (2000..2060).contains(&k) { 0.0 } else { force(k) + 1e-3 * noise });
        assert_eq!(lost.iter().filter(|found| **found).count(), 60);
        let saturated = rows(|k, noise| (force(k) + 1e-3 * noise).min(0.8));
        assert!(
            (0..4000).all(|k| !saturated[k] || force(k) > 0.795)
                && saturated.iter().filter(|found| **found).count() > 580
        );
        // for most of the recording
        let lost = rows(|k, noise| if k > 1500 { 0.0 } else { force(k) + 1e-3 * noise });
        assert!((0..4000).all(|k| lost[k] == (k > 1500)));
        assert!(!rows(|_, _| 0.25).contains(&false));
        // of a converter, too, whose last digit is less than the noise
        let coarse = |v: f64| (v / 5e-4).round() * 5e-4;
        let stuck = rows(|k, noise| coarse(if (2000..2200).contains(&k) { 0.25 } else { force(k) + 1e-3 * noise }));
        assert!((2000..2200).all(|k| stuck[k]) && stuck.iter().filter(|found| **found).count() < 205);
    }

    #[test]
    fn a_free_rod_without_noise_is_not_stuck() {
        assert!(!rows(|k, _| force(k)).contains(&true));
        for digit in [1e-9, 1e-6, 1e-4, 1e-2] {
            assert!(!rows(|k, _| (force(k) / digit).round() * digit).contains(&true), "{digit}");
            assert!(
                !rows(|k, noise| ((force(k) + 0.2 * digit * noise) / digit).round() * digit).contains(&true),
                "{digit}"
            );
        }
        // held values
        assert!(
            !rows(|k, noise| force(k / 50 * 50) + 0.0 * noise + 1e-3 * ((k / 50) as f64 * 12.9898).sin())
                .contains(&true)
        );
    }
}
