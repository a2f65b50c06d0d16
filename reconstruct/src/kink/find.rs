//! Kinks and jumps of a whole recording.

use super::scale::KinkOptions;
use super::search::Detector;
use super::transition::Kink;
use crate::scan::noise_estimate::ChannelNoise;

/// Kinks and jumps of three channels sampled at `tau` (increasing strictly), in order.
///
/// Half-windows grow from 4 samples to `options.widest` by factors of at most 1.5. The samples need not be evenly spaced. Of slices
/// of different lengths the first samples are used. Where the noise at long times (drift, low-pass filters, hum) exceeds `noise`,
/// that is measured in the channels and reckoned with. Where `tau` does not increase or a value is not finite, the list is empty.
pub fn find_kinks(tau: &[f64], channels: [&[f64]; 3], noise: &[ChannelNoise; 3], options: KinkOptions) -> Vec<Kink> {
    let count = channels.iter().fold(tau.len(), |n, c| n.min(c.len()));
    let tau = &tau[..count];
    let channels = channels.map(|c| &c[..count]);
    let increases = tau.windows(2).all(|w| w[1] > w[0]);
    if count < 8 || !increases || channels.iter().any(|c| c.iter().any(|y| !y.is_finite())) {
        return Vec::new();
    }
    let spacing = (tau[count - 1] - tau[0]) / (count - 1) as f64;
    let options = KinkOptions { widest: options.widest.min(tau[count - 1] - tau[0]), ..options };
    let mut detector = Detector::new(count, spacing, *noise, options).with_coloured_noise(tau, channels);
    detector.run(tau, channels, count);
    detector.transitions().collect()
}
