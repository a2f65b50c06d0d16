//! Kinks and jumps of the reactions along the path of the clamp: where one contact phase gives way to another.
//!
//! At every place and at many scales, a quadratic with a step and a hinge is fitted to the samples on either side; what
//! it explains beyond a quadratic is judged by the noise, by its own misfit, and against a quartic, which has as many
//! parameters and no corner. From the finest scale to the coarsest, what stands out is taken, and no later window
//! reaches across it; a free-knot fit then places it between the samples.

mod basis;
mod filter;
mod level;
mod refine;
mod search;
mod threshold;

use crate::noise_estimate::ChannelNoise;
use search::Detector;

pub use filter::KinkFilter;

/// What happens at a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KinkKind {
    /// The channels go on continuously, their slopes do not.
    Kink,
    /// The channels jump: a snap, a slip, a snap-off.
    Jump,
}

/// A kink or a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// Where, in units of the path parameter.
    pub tau: f64,
    /// Standard deviation of `tau`.
    pub sigma_tau: f64,
    /// Index of the first sample after it.
    pub next: usize,
    /// What it is.
    pub kind: KinkKind,
    /// Change of slope (kink) or value (jump) of each channel.
    pub change: [f64; 3],
    /// Standard deviations of the changes.
    pub sigma: [f64; 3],
    /// Sum over channels of (change / sigma)^2.
    pub score: f64,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinkOptions {
    /// False alarms per recording, where there is nothing but noise: a bound, not the expected number.
    pub false_alarms: f64,
    /// Longest half-window, in units of the path parameter.
    pub widest: f64,
}

impl Default for KinkOptions {
    /// 0.05 false alarms and half-windows up to 0.08, lengths of the rod.
    fn default() -> Self {
        Self { false_alarms: 0.05, widest: 0.08 }
    }
}

/// Kinks and jumps of three channels sampled at `tau` (increasing strictly), in order.
///
/// Half-windows run from 4 samples to `options.widest` in steps of at most 1.5; places need no even spacing. Slices of
/// different lengths are taken as long as the shortest. Where `tau` does not increase or a value is not finite, there
/// is no answer: the list is empty.
pub fn find_kinks(tau: &[f64], channels: [&[f64]; 3], noise: &[ChannelNoise; 3], options: KinkOptions) -> Vec<Kink> {
    let count = channels.iter().fold(tau.len(), |n, c| n.min(c.len()));
    let tau = &tau[..count];
    let channels = channels.map(|c| &c[..count]);
    let increases = tau.windows(2).all(|w| w[1] > w[0]);
    if count < 8 || !increases || channels.iter().any(|c| c.iter().any(|y| !y.is_finite())) {
        return Vec::new();
    }
    let spacing = (tau[count - 1] - tau[0]) / (count - 1) as f64;
    let mut detector = Detector::new(count, spacing, *noise, options);
    detector.run(tau, channels, count);
    detector.found().collect()
}
