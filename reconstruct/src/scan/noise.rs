//! The noise of the three reactions of a scan, dimensionless.

use super::noise_estimate::ChannelNoise;
use nalgebra::Vector3;
use rod_core::Units;

/// Smallest standard deviation of a sample, dimensionless: the error that a solver and a file with 17 digits leave. Smaller:
/// windows of noise-free scans stay needlessly short, because rounding is taken for signal.
const ROUNDING: f64 = 1e-13;
/// Standard deviation, dimensionless, below which a sample is called clean and used as it is. Larger: fits, which have a bias,
/// stay out of use although their noise would be less than that of the sample.
const CLEAN: f64 = 1e-9;

/// The noise of a sample of f0x, f0y, m0z, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Noise {
    /// Variances of a sample.
    pub variance: Vector3<f64>,
    /// Variance of a long mean as a multiple of that of as many independent samples.
    pub long_run: Vector3<f64>,
}

impl Noise {
    /// From the (dimensionless) noise of each channel, which is at least the rounding error.
    pub fn new(channels: &[ChannelNoise; 3]) -> Self {
        Self {
            variance: Vector3::from_fn(|c, _| channels[c].sigma.max(ROUNDING).powi(2)),
            long_run: Vector3::from_fn(|c, _| channels[c].long_run.max(1.0)),
        }
    }

    /// Whether a sample itself is better than a fit through its neighbours.
    pub fn is_clean(&self) -> bool {
        self.variance.max() < CLEAN * CLEAN
    }
}

/// The noise of f0x, f0y (N) and m0z (N m) made dimensionless.
pub(crate) fn dimensionless(noise: &[ChannelNoise; 3], units: Units) -> [ChannelNoise; 3] {
    let size = [units.force, units.force, units.moment];
    std::array::from_fn(|c| ChannelNoise { sigma: noise[c].sigma / size[c], ..noise[c] })
}
