//! Kinks and jumps of the reactions along the path of the clamp: where one contact phase gives way to another.
//!
//! At every place and at many scales, a quadratic with a step and a hinge is fitted to the samples on either side; what
//! it explains beyond a quadratic is judged by the noise, by its own misfit, and against a quartic, which has as many
//! parameters and no corner. From the finest scale to the coarsest, what stands out is taken, and no later window
//! reaches across it; a free-knot fit then places it between the samples.
//!
//! Measured on the nine scans of Merker et al. (2020), 85,001 samples each, 20 noise draws a scan, wire of 100 mm and
//! 6.32e-4 N m^2, noise estimated from the data, a transition (all but A -> B) found within 1 mm
//! (`cargo test --release -p rod-reconstruct --test suite kinks_of_the_paper -- --ignored --nocapture`):
//!
//! | noise | found | false a scan | median error of position |
//! |---|---|---|---|
//! | none (one scan each) | 51 of 51 | 0 | 1e-6 mm |
//! | 0.2 mN / 0.02 mN m, white | 100 % | 0.16 | 0.0010 mm |
//! | the same, AR(1) of 0.45 | 100 % | 0.08 | 0.0014 mm |
//! | 2.5 mN / 0.06 mN m, white | 99.9 % | 0.09 | 0.0067 mm |
//! | the same, AR(1) of 0.45 | 99.1 % | 0.11 | 0.0097 mm |
//! | 10 mN / 0.5 mN m, white | 89.2 % | 0.08 | 0.024 mm |
//! | the same, AR(1) of 0.45 | 71.0 % | 0.08 | 0.022 mm |
//!
//! Errors of position are 1.0 to 1.3 of the stated standard deviation in the median, where 0.67 is due: curvature, too,
//! breaks at a kink. Noise that is not the same all along a recording (places that are wrong where slopes are large)
//! makes false alarms.

mod basis;
mod filter;
mod free_knot;
mod level;
mod scale;
mod search;

use crate::scan::noise_estimate::ChannelNoise;
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
    /// Standard deviation of `tau` from the noise alone; for a jump, of a place anywhere between two samples.
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
    /// 0.1 false alarms and half-windows up to 0.08, lengths of the rod.
    fn default() -> Self {
        Self { false_alarms: 0.1, widest: 0.08 }
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
    let options = KinkOptions { widest: options.widest.min(tau[count - 1] - tau[0]), ..options };
    let mut detector = Detector::new(count, spacing, *noise, options);
    detector.run(tau, channels, count);
    detector.found().collect()
}

/// White-equivalent noise of each channel, no less than a trace of its largest value. Noise whose neighbours are
/// opposed counts as white, for short windows see all of it.
fn equivalents(noise: &[ChannelNoise; 3], channels: [&[f64]; 3]) -> [f64; 3] {
    let mut sigma = [0.0; 3];
    for ((sigma, noise), channel) in sigma.iter_mut().zip(noise).zip(channels) {
        let largest = channel.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        let least = (f64::EPSILON * largest).max(f64::MIN_POSITIVE.sqrt());
        *sigma = (noise.sigma * noise.long_run.max(1.0).sqrt()).max(least);
    }
    sigma
}
