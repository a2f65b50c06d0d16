//! Settings of a live reconstruction.

use crate::kink::KinkOptions;
use crate::scan::noise_estimate::ChannelNoise;

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
}
