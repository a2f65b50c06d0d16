//! The noise of a channel, estimated from the channel itself.

use super::bands::Bands;
use super::polynomials::Bases;
use super::quantum::quantum;
use crate::numeric::chi_squared::wilson_hilferty;
use crate::numeric::{dot, subtract};
use nalgebra::{DMatrix, DVector};

/// The random noise of one channel, in the channel's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelNoise {
    /// Standard deviation of a sample.
    pub sigma: f64,
    /// Correlation of neighbouring samples, in [-1, 1].
    pub lag1: f64,
    /// Variance of the mean of a long block of b samples, times b, over the variance of a sample: 1 for white noise,
    /// (1 + rho) / (1 - rho) for AR(1) noise of correlation rho.
    pub long_run: f64,
}

impl ChannelNoise {
    /// White noise of standard deviation `sigma`.
    pub fn white(sigma: f64) -> Self {
        Self { sigma, lag1: 0.0, long_run: 1.0 }
    }

    /// Standard deviation of white noise with the same effect on means and fits over many samples.
    pub fn equivalent(&self) -> f64 {
        self.sigma * self.long_run.max(0.0).sqrt()
    }
}

/// Degree of the polynomials that are taken off each window. Higher: less of the signal is left in the residuals, and fewer
/// degrees of freedom are left for the noise.
const DEGREE: usize = 4;
const COLUMNS: usize = DEGREE + 1;
/// Samples of a window. The longest one is used whose residuals are no larger than those of the shorter ones.
const WINDOWS: [usize; 4] = [8, 16, 32, 64];
/// Largest ratio of the residual variance in windows of twice the length that is still the correlation of the noise: AR(1) noise of
/// 0.9 gives 1.9. A larger ratio is signal.
const CORRELATED: f64 = 2.0;
/// Windows whose residuals exceed the median by this many standard deviations (of a normal variable of the same probability) are left
/// out: they hold a kink, a jump or an outlier.
const OUTLYING: f64 = 4.5;
/// Lags up to this one enter the long-run variance.
const LAGS: usize = 8;
/// Levels of long times: the longest have periods of some 1300 samples. More: slow drift counts as noise of all windows, even of
/// those that are too short to see it.
const LEVELS: usize = 9;
/// Share of the frequencies (of half the sampling rate) below the geometric mean of the frequencies of the first two levels.
const BAND: f64 = 0.28;
/// The noise is at least this share of the largest sample: rounding of a number.
const ROUNDING: f64 = 1.0 / (1u64 << 52) as f64;

/// The noise of `channel`, sampled at `tau` (increasing, not necessarily evenly), on a signal that is smooth but for kinks and
/// jumps.
///
/// It is estimated from the residuals of quartics over short windows. Left out are windows in which a kink, a jump or an outlier
/// makes the residuals stand out, windows with values that are not finite, and windows without any residual, unless all are.
///
/// On 85,000 samples of white noise or AR(1) noise of correlations from -0.4 to 0.45 the standard deviation is right to 1 % and
/// `long_run` to 8 %. Power at longer times (drift, low-pass filters, hum) is added where it
/// exceeds that of the windows and does not grow as a smooth signal does; its `long_run` is right to a factor of 2 or 3. The standard deviation is at least the rounding of the largest
/// sample, and at least q / sqrt 12 where most differences of neighbours are multiples of a quantum q. For fewer than 8 samples
/// the standard deviation about their mean is returned.
///
/// ```
/// use rod_reconstruct::noise_estimate::estimate;
/// let tau: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
/// // signs that look random, without a generator
/// let sign = |i: u32| if i.wrapping_mul(i).wrapping_mul(2_654_435_769).count_ones() % 2 == 0 { 1.0 } else { -1.0 };
/// let noisy: Vec<f64> = (0..1000).map(|i| (3e-3 * f64::from(i)).sin() + 0.01 * sign(i)).collect();
/// let noise = estimate(&tau, &noisy);
/// assert!((noise.sigma - 0.01).abs() < 0.001);
/// ```
pub fn estimate(tau: &[f64], channel: &[f64]) -> ChannelNoise {
    let count = tau.len().min(channel.len());
    let (tau, channel) = (&tau[..count], &channel[..count]);
    let largest = channel.iter().filter(|y| y.is_finite()).fold(0.0_f64, |m, y| m.max(y.abs()));
    let floor = (ROUNDING * largest).max(quantum(channel).unwrap_or(0.0) / 12.0_f64.sqrt());
    let mut best = ChannelNoise::white(scatter(channel));
    let mut variance = f64::INFINITY;
    for (k, &length) in WINDOWS.iter().enumerate() {
        // the shortest windows must do for a short channel; longer ones only where there are many
        if count < length || (k > 0 && count < 8 * length) {
            break;
        }
        let Some(found) = Windows::of(tau, channel, length) else { break };
        if k > 0 && found.white_variance > CORRELATED * variance.max(floor * floor) {
            break;
        }
        variance = found.white_variance;
        best = found.noise();
    }
    let noise = ChannelNoise { sigma: best.sigma.max(floor), ..best };
    with_long_times(noise, &Bands::of(tau, channel, noise.equivalent().powi(2)))
}

/// Adds the noise at times that the windows do not see, where there is more of it.
fn with_long_times(noise: ChannelNoise, bands: &Bands) -> ChannelNoise {
    let known = noise.equivalent().powi(2);
    let levels = bands.levels().min(LEVELS);
    let most = (1..levels).map(|level| bands.excess(level, known)).fold(1.0, f64::max);
    if most <= 1.0 || known <= 0.0 {
        return noise;
    }
    // a level stands for the frequencies of half a power of two, the first for all higher ones, the last for all lower ones
    let share = |level: usize| match level {
        0 => 1.0 - BAND,
        _ if level + 1 == levels => BAND * 2.0_f64.powi(1 - level as i32),
        _ => BAND * 2.0_f64.powi(-(level as i32)),
    };
    let variance = (0..levels).map(|level| share(level) * bands.at(level)).sum::<f64>().max(noise.sigma.powi(2));
    ChannelNoise { sigma: variance.sqrt(), lag1: noise.lag1, long_run: (most * known / variance).max(1.0) }
}

/// Sums of products of residuals over all good windows of a length.
struct Windows {
    length: usize,
    /// Mean over windows of sum r_i r_{i + k}, k = 0, 1, ...
    products: Vec<f64>,
    /// Variance of a sample were the noise white.
    white_variance: f64,
}

impl Windows {
    fn of(tau: &[f64], channel: &[f64], length: usize) -> Option<Self> {
        let lags = (length / 8).clamp(1, LAGS);
        let mut bases = Bases::<COLUMNS>::new(length);
        let mut residual = vec![0.0; length];
        let mut sums: Vec<(f64, [f64; LAGS + 1])> = Vec::new();
        for (t, y) in tau.chunks_exact(length).zip(channel.chunks_exact(length)) {
            let basis = bases.at(t);
            let middle = y[length / 2];
            residual.iter_mut().zip(y).for_each(|(r, y)| *r = y - middle);
            for column in basis {
                let share = dot(&residual, column);
                subtract(&mut residual, share, column);
            }
            let mut products = [0.0; LAGS + 1];
            for (k, product) in products.iter_mut().enumerate().take(lags + 1) {
                *product = dot(&residual[..length - k], &residual[k..]);
            }
            if products[0].is_finite() {
                sums.push((products[0], products));
            }
        }
        // windows without residual come from a free rod or a coarse quantum, and are no measure of the noise elsewhere
        if sums.iter().any(|s| s.0 > 0.0) {
            sums.retain(|s| s.0 > 0.0);
        }
        sums.sort_by(|a, b| a.0.total_cmp(&b.0));
        let median = sums.get(sums.len() / 2)?.0;
        let freedom = length - COLUMNS;
        let outlying = wilson_hilferty(freedom, OUTLYING) / wilson_hilferty(freedom, 0.0);
        let good = sums.partition_point(|s| s.0 <= median * outlying);
        let mut products = vec![0.0; lags + 1];
        for (_, window) in &sums[..good] {
            products.iter_mut().zip(window).for_each(|(sum, p)| *sum += p / good as f64);
        }
        Some(Self { length, white_variance: products[0] / freedom as f64, products })
    }

    /// Covariances from the products, corrected for what the polynomials have taken off.
    fn noise(&self) -> ChannelNoise {
        let white = ChannelNoise::white(self.white_variance.sqrt());
        let lags = self.products.len();
        let Some(covariances) = taken_part(self.length, lags).lu().solve(&DVector::from_column_slice(&self.products))
        else {
            return white;
        };
        let variance = covariances[0];
        if variance <= 0.0 || variance.is_nan() {
            return white;
        }
        // a long-run variance of almost 0 is an accident of the estimate
        let long_run = 1.0 + 2.0 * covariances.iter().skip(1).map(|c| c / variance).sum::<f64>();
        ChannelNoise {
            sigma: variance.sqrt(),
            lag1: (covariances[1] / variance).clamp(-1.0, 1.0),
            long_run: long_run.max(0.1),
        }
    }
}

/// The matrix that maps covariances at lags 0, 1, ... to the expected sums of products of residuals over a window.
fn taken_part(length: usize, lags: usize) -> DMatrix<f64> {
    let t: Vec<f64> = (0..length).map(|i| i as f64).collect();
    let mut bases = Bases::<COLUMNS>::new(length);
    let basis = bases.at(&t);
    let q = DMatrix::from_fn(length, COLUMNS, |i, j| basis[j][i]);
    let rest = DMatrix::identity(length, length) - &q * q.transpose();
    let mut matrix = DMatrix::zeros(lags, lags);
    for j in 0..lags {
        let toeplitz = DMatrix::from_fn(length, length, |a, b| if a.abs_diff(b) == j { 1.0 } else { 0.0 });
        let covariance = &rest * toeplitz * &rest;
        for k in 0..lags {
            matrix[(k, j)] = (0..length - k).map(|i| covariance[(i, i + k)]).sum();
        }
    }
    matrix
}

/// Standard deviation about the mean.
fn scatter(channel: &[f64]) -> f64 {
    let finite = || channel.iter().filter(|y| y.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    (finite().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}
