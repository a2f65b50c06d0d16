//! Settings of a live reconstruction.

use super::settings::ReconstructError;
use crate::kink::KinkOptions;
use crate::scan::Travel;
use crate::scan::noise_estimate::{ChannelNoise, estimate};
use rod_core::{Reactions, Rod, Sample};

/// Half-window, rod lengths. Larger: smaller kinks are detected, later.
const HALF_WINDOW: f64 = 0.02;
/// Fewest samples of a half-window, if it is derived from a recording: fewer detect only large kinks.
const FEWEST_IN_HALF_WINDOW: f64 = 200.0;
/// Number of samples for which a rounded signal without noise keeps its value, about: over these its errors are equal.
const STEP: f64 = 64.0;

/// Settings of a live reconstruction, which must be known before the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveSettings {
    /// Noise of f0x, f0y (N) and m0z (N m): estimated from samples of the free rod
    /// ([`noise_estimate::estimate`](crate::noise_estimate::estimate)), or from the manual of the sensor.
    pub noise: [ChannelNoise; 3],
    /// Path length of the clamp from one sample to the next, about, m.
    pub spacing: f64,
    /// Half-window, m: path length on either side of a sample whose reactions are used. Twice the half-window detects kinks 2.8 times
    /// smaller, twice as late.
    pub half_window: f64,
    /// Upper bound of the expected number of false alarms of the kink filter in 100,000 samples.
    pub false_alarms: f64,
    /// Largest standard deviation of a contact point across the contour, in lengths of the rod.
    pub largest_sigma: f64,
}

impl LiveSettings {
    /// For samples with this noise at this distance (m): half-windows of 1000 samples.
    pub fn new(noise: [ChannelNoise; 3], spacing: f64) -> Self {
        let false_alarms = KinkOptions::default().false_alarms;
        Self { noise, spacing, half_window: 1000.0 * spacing, false_alarms, largest_sigma: 0.02 }
    }

    /// Fewest samples of the free rod that [`of_free_rod`](Self::of_free_rod) needs.
    pub const FEWEST_FREE: usize = 100;

    /// Noise and spacing from samples of the free rod, and half-windows of 0.02 rod lengths, or 200 samples where these are longer.
    ///
    /// `rounding` is the standard deviation by rounding in the sensor (N, N m), zero where it is not known: the noise is at least as
    /// large, and then correlated over 64 samples.
    ///
    /// # Errors
    /// [`ReconstructError::TooFew`]: fewer than [`FEWEST_FREE`](Self::FEWEST_FREE) samples along the path of the clamp.
    pub fn of_free_rod(rod: &Rod, samples: &[Sample], rounding: Reactions) -> Result<Self, ReconstructError> {
        let mut travel = Travel::new(rod);
        let moving: Vec<(f64, Reactions)> =
            samples.iter().filter_map(|sample| Some((travel.go(&sample.pose).ok()?, sample.reactions))).collect();
        if moving.len() < Self::FEWEST_FREE {
            let (usable, fewest) = (moving.len(), Self::FEWEST_FREE);
            return Err(ReconstructError::TooFew { usable, samples: samples.len(), fewest });
        }
        let tau: Vec<f64> = moving.iter().map(|row| row.0).collect();
        let spacing = tau.last().copied().unwrap_or_default() / (tau.len() - 1) as f64;
        let channels = |r: &Reactions| [r.f0x, r.f0y, r.m0z];
        let noise = [0, 1, 2].map(|c| {
            let channel: Vec<f64> = moving.iter().map(|row| channels(&row.1)[c]).collect();
            let (found, rounding) = (estimate(&tau, &channel), channels(&rounding)[c]);
            if found.sigma > rounding {
                return found;
            }
            ChannelNoise { sigma: rounding, lag1: 1.0 - 1.0 / STEP, long_run: STEP, spread: 0.0 }
        });
        let half_window = (HALF_WINDOW * rod.length()).max(FEWEST_IN_HALF_WINDOW * spacing);
        Ok(Self { half_window, ..Self::new(noise, spacing) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::Pose;

    #[test]
    fn the_free_rod_gives_noise_spacing_and_half_window() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let sample = |k: u32| {
            let bits = k.wrapping_mul(k).wrapping_mul(2_654_435_769).count_ones();
            let sign = [1e-3, -1e-3][bits as usize % 2];
            let pose = Pose { x: 2e-6 * f64::from(k), y: 0.0, phi: 1.5 };
            Sample::new(pose, Reactions { f0x: sign, ..Reactions::default() })
        };
        let samples: Vec<Sample> = (0..1000).map(sample).collect();
        let rounding = Reactions { f0y: 1e-4, ..Reactions::default() };
        let settings = LiveSettings::of_free_rod(&rod, &samples, rounding).unwrap();
        assert!((settings.noise[0].sigma - 1e-3).abs() < 1e-4 && settings.noise[1].sigma == 1e-4);
        assert!((settings.spacing - 2e-6).abs() < 1e-15 && (settings.half_window - 2e-3).abs() < 1e-15);
        let few = LiveSettings::of_free_rod(&rod, &samples[..99], rounding);
        assert!(matches!(few, Err(ReconstructError::TooFew { usable: 99, fewest: 100, .. })));
    }
}
