//! Whether a contour explains its recording.

use super::blocks::Block;
use super::problem::Explained;
use crate::numeric::chi_squared::beyond;
use crate::systematic::Source;
use std::ops::Range;

/// Blocks of a window.
const WINDOW: usize = 12;
/// Relative standard deviation of the noise of a long recording: by so much it is no noise of the model.
const NOISE_KNOWN_TO: f64 = 0.03;
/// Probability below which a recording is not explained.
pub(super) const UNLIKELY: f64 = 1e-4;
/// Probability of an explanation from which on no other contour is looked for. Larger: more time, as good contours have smaller ones by chance so often.
const RARE: f64 = 0.01;
/// Names of the channels.
const CHANNELS: [&str; 3] = ["f0x", "f0y", "m0z"];

/// The place at which a recording is explained worst.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorstWindow {
    /// The samples from the first to after the last.
    pub samples: Range<usize>,
    /// The channel that is off most there.
    pub channel: String,
    /// Sum of the squares of its residuals over their standard deviations, of all channels.
    pub chi_squared: f64,
    /// How many these are.
    pub residuals: usize,
    /// Probability of a sum as large or larger in any window of the recording.
    pub p_value: f64,
}

/// How well a contour explains a recording: residuals of means of blocks of samples over the standard deviations of their noise.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Goodness {
    /// Sum of the squares.
    pub chi_squared: f64,
    /// Number of residuals less the unknowns that the recording determines.
    pub degrees_of_freedom: f64,
    /// Relative variance of the squares of the standard deviations, which are estimated from the recording.
    pub noise_spread: f64,
    /// Probability of a sum as large or larger.
    pub p_value: f64,
    /// Where it is worst; none for a recording shorter than a window.
    pub worst: Option<WorstWindow>,
    /// Share of the blocks of samples at whose poses the model has no state: it has jumped there, or cannot be followed.
    pub unreached: f64,
    /// The error that all samples share which is farthest off what is known of it, in standard deviations of its budget; none where no errors are
    /// estimated.
    pub farthest_error: Option<(Source, f64)>,
    /// Whether the recording is explained: neither probability is below 1e-4, no more than 2 % of the blocks are not reached, and no error is off
    /// by more than five standard deviations of its budget.
    pub explains: bool,
}

/// Standard deviations of its budget by which an error may be off what is known of it. A free contour explains nearly any recording if its errors
/// may be of any size: a rod that is 10 % shorter than given, with a length error of 13 standard deviations.
const MOST_OFF: f64 = 5.0;

/// Largest share of blocks that are not reached of a recording that is explained: those beside a jump that the model makes a little earlier.
pub(super) const MOST_UNREACHED: f64 = 0.02;

/// Probability of a sum of squares as large or larger of so many degrees of freedom, where the noise has this relative variance: that of an F distribution
/// with 2 / `noise_spread` degrees of freedom below, by the approximation of Paulson (1942). Within a fifth of itself down to 1e-5 from 30 degrees of freedom
/// on either side on.
pub(super) fn probability(chi_squared: f64, degrees_of_freedom: f64, noise_spread: f64) -> f64 {
    let (above, below) = (2.0 / (9.0 * degrees_of_freedom), noise_spread / 9.0);
    let root = (chi_squared / degrees_of_freedom).max(0.0).cbrt();
    beyond(((1.0 - below) * root - (1.0 - above)) / (below * root * root + above).sqrt())
}

impl Goodness {
    /// From the residuals of these blocks. `determined` is the number of unknowns that the recording determines.
    pub(super) fn of(
        explained: &Explained,
        blocks: &[Block],
        determined: f64,
        farthest_error: Option<(Source, f64)>,
    ) -> Self {
        let known: Vec<usize> = (0..blocks.len()).filter(|k| explained.residuals[*k].is_some()).collect();
        let square = |k: &usize| explained.residuals[*k].map_or(0.0, |residual| residual.norm_squared());
        let chi_squared: f64 = known.iter().map(square).sum();
        let degrees_of_freedom = (3.0 * known.len() as f64 - determined).max(1.0);
        let of_recording =
            |own: &[usize]| (own.len() as f64 / known.len() as f64).powi(2) * blocks[own[0]].noise_spread;
        let recordings = known.chunk_by(|k, next| blocks[*k].recording == blocks[*next].recording);
        let noise_spread = (2.0 * NOISE_KNOWN_TO).powi(2) + recordings.map(of_recording).sum::<f64>();
        let p_value = probability(chi_squared, degrees_of_freedom, noise_spread);
        let windows = known.len() as f64 / WINDOW as f64;
        let worst = known.windows(WINDOW).map(|window| (window.iter().map(square).sum::<f64>(), window));
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(sum, window)| {
            let of_channel = |c: usize| {
                let squares = window.iter().filter_map(|k| explained.residuals[*k]).map(|residual| residual[c].powi(2));
                squares.sum::<f64>()
            };
            let channel = (0..3).max_by(|a, b| of_channel(*a).total_cmp(&of_channel(*b))).unwrap_or(0);
            let p = probability(sum, 3.0 * WINDOW as f64, noise_spread);
            WorstWindow {
                samples: blocks[window[0]].samples.start..blocks[window[WINDOW - 1]].samples.end,
                channel: CHANNELS[channel].to_owned(),
                chi_squared: sum,
                residuals: 3 * WINDOW,
                // windows that overlap count as a few independent ones
                p_value: (3.0 * windows * p).min(1.0),
            }
        });
        let lost = explained.unreached + explained.others;
        let unreached = lost as f64 / (lost + known.len()).max(1) as f64;
        let mut found = Self {
            chi_squared,
            degrees_of_freedom,
            noise_spread,
            p_value,
            worst,
            unreached,
            farthest_error,
            explains: false,
        };
        found.explains = p_value >= UNLIKELY
            && found.unlikely_window().is_none()
            && !found.is_unreached()
            && found.error_beyond_budget().is_none();
        found
    }

    /// Whether the recording is explained so well that no other contour is looked for.
    pub(super) fn explains_well(&self) -> bool {
        let least = self.worst.as_ref().map_or(self.p_value, |worst| worst.p_value.min(self.p_value));
        self.explains && least >= RARE
    }

    /// The worst window, where it is too unlikely for a recording that is explained.
    pub fn unlikely_window(&self) -> Option<&WorstWindow> {
        self.worst.as_ref().filter(|worst| worst.p_value < UNLIKELY)
    }

    /// Whether more blocks are not reached than of a recording that is explained.
    pub fn is_unreached(&self) -> bool {
        self.unreached > MOST_UNREACHED
    }

    /// The farthest error, where it is farther off what is known than of a recording that is explained.
    pub fn error_beyond_budget(&self) -> Option<(Source, f64)> {
        self.farthest_error.filter(|error| error.1.abs() > MOST_OFF)
    }
}

#[cfg(test)]
mod tests {
    use super::probability;

    #[test]
    fn noise_that_is_estimated_makes_a_tail_heavier() {
        // SciPy: stats.chi2.sf(80, 36), and stats.f.sf(ratio, freedom, below)
        assert!((probability(80.0, 36.0, 0.0) / 3.47e-5 - 1.0).abs() < 0.1);
        for (ratio, freedom, below, p) in [
            (1.5, 100.0, 60.0, 0.044_89),
            (1.7, 98.0, 200.0, 8.598e-4),
            (1.3, 1000.0, 500.0, 4.427e-4),
            (2.6, 36.0, 555.0, 2.148e-6),
        ] {
            let found = probability(ratio * freedom, freedom, 2.0 / below);
            assert!((found / p - 1.0).abs() < 0.2, "{ratio} {freedom} {below} {found}");
        }
    }
}
