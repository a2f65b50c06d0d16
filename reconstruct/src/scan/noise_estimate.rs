//! The noise of a channel, estimated from the channel itself.

use nalgebra::{DMatrix, DVector};

/// The random noise of one channel, in the channel's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelNoise {
    /// Standard deviation of a sample.
    pub sigma: f64,
    /// Correlation of neighbouring samples, in [-1, 1].
    pub lag1: f64,
    /// Variance of the mean of a long block of b samples, times b, over the variance of a sample: 1 for white noise,
    /// (1 + rho) / (1 - rho) for AR(1).
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

/// Degree of the polynomials that take the signal out of a window.
const DEGREE: usize = 4;
const COLUMNS: usize = DEGREE + 1;
/// Samples of a window. The longest is used whose residuals are no larger than those of the shorter ones.
const WINDOWS: [usize; 4] = [8, 16, 32, 64];
/// So much more residual variance in windows of twice the length is still colour of the noise (AR(1) of 0.9 gives 1.9);
/// more is signal.
const COLOUR: f64 = 2.0;
/// Windows whose residuals are beyond so many standard deviations of a normal variable hold a kink, jump or outlier.
const OUTLYING: f64 = 4.5;
/// Correlations up to this lag enter the long-run variance.
const LAGS: usize = 8;
/// Rounding of the samples: no noise is smaller than this share of the largest one.
const ROUNDING: f64 = 1.0 / (1u64 << 52) as f64;

/// The noise of `channel`, sampled at `tau` (increasing, not necessarily evenly), on a signal that is smooth but for
/// kinks and jumps: residuals of quartics over short windows, those windows left out that a kink, a jump or an outlier
/// makes stand out. Values that are not finite are left out with their windows; so are windows without any residual,
/// unless there are only such.
///
/// The standard deviation is right to 1 % and `long_run` to 8 % on 85,000 samples of white noise or AR(1) noise of
/// correlations from -0.4 to 0.45; correlations beyond 8 samples are not seen. It is never less than the rounding of
/// the largest sample, nor than that of a quantum that most differences of neighbours are multiples of (q / sqrt 12). Fewer
/// than 8 samples tell nothing: their standard deviation about their mean is returned.
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
        if k > 0 && found.white_variance > COLOUR * variance.max(floor * floor) {
            break;
        }
        variance = found.white_variance;
        best = found.noise();
    }
    ChannelNoise { sigma: best.sigma.max(floor), ..best }
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
        let mut basis = vec![[0.0; COLUMNS]; length];
        let mut spacing = f64::NAN;
        let mut residual = vec![0.0; length];
        let mut sums: Vec<(f64, [f64; LAGS + 1])> = Vec::new();
        for (t, y) in tau.chunks_exact(length).zip(channel.chunks_exact(length)) {
            let shape = t[length - 1] - t[0];
            let evenly = even_enough(t, shape);
            let same = evenly && (shape - spacing).abs() < 1e-6 * shape;
            if !same {
                spacing = if evenly { shape } else { f64::NAN };
                orthonormal(t, &mut basis);
            }
            let middle = y[length / 2];
            residual.iter_mut().zip(y).for_each(|(r, y)| *r = y - middle);
            for column in 0..COLUMNS {
                let share: f64 = residual.iter().zip(&basis).map(|(r, b)| r * b[column]).sum();
                residual.iter_mut().zip(&basis).for_each(|(r, b)| *r -= share * b[column]);
            }
            let mut products = [0.0; LAGS + 1];
            for (k, product) in products.iter_mut().enumerate().take(lags + 1) {
                *product = residual.iter().zip(&residual[k..]).map(|(a, b)| a * b).sum();
            }
            if products[0].is_finite() {
                sums.push((products[0], products));
            }
        }
        // windows without residual are of a free rod or of a coarse quantum: they say nothing of the others
        if sums.iter().any(|s| s.0 > 0.0) {
            sums.retain(|s| s.0 > 0.0);
        }
        sums.sort_by(|a, b| a.0.total_cmp(&b.0));
        let median = sums.get(sums.len() / 2)?.0;
        let freedom = (length - COLUMNS) as f64;
        let good = sums.partition_point(|s| s.0 <= median * outlying(freedom));
        let mut products = vec![0.0; lags + 1];
        for (_, window) in &sums[..good] {
            products.iter_mut().zip(window).for_each(|(sum, p)| *sum += p / good as f64);
        }
        Some(Self { length, white_variance: products[0] / freedom, products })
    }

    /// Covariances from the products, of which the polynomials took their part.
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
        // noise that cancels in means altogether is too good to be relied on
        let long_run = 1.0 + 2.0 * covariances.iter().skip(1).map(|c| c / variance).sum::<f64>();
        ChannelNoise {
            sigma: variance.sqrt(),
            lag1: (covariances[1] / variance).clamp(-1.0, 1.0),
            long_run: long_run.max(0.1),
        }
    }
}

/// The matrix that takes covariances at lags 0, 1, ... to the expected sums of products of residuals over a window.
fn taken_part(length: usize, lags: usize) -> DMatrix<f64> {
    let t: Vec<f64> = (0..length).map(|i| i as f64).collect();
    let mut basis = vec![[0.0; COLUMNS]; length];
    orthonormal(&t, &mut basis);
    let q = DMatrix::from_fn(length, COLUMNS, |i, j| basis[i][j]);
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

/// Orthonormal polynomials up to the degree at the places `t`, by Gram and Schmidt, each twice.
fn orthonormal(t: &[f64], basis: &mut [[f64; COLUMNS]]) {
    let (first, last) = (t[0], t[t.len() - 1]);
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
    for (row, t) in basis.iter_mut().zip(t) {
        let u = (t - middle) / half;
        let mut power = 1.0;
        for value in row.iter_mut() {
            *value = power;
            power *= u;
        }
    }
    for column in 0..COLUMNS {
        for _ in 0..2 {
            for before in 0..column {
                let share: f64 = basis.iter().map(|b| b[before] * b[column]).sum();
                basis.iter_mut().for_each(|b| b[column] -= share * b[before]);
            }
        }
        let norm = basis.iter().map(|b| b[column] * b[column]).sum::<f64>().sqrt();
        basis.iter_mut().for_each(|b| b[column] /= norm);
    }
}

/// Whether places are evenly spaced but for rounding, so that one basis serves for many windows.
fn even_enough(t: &[f64], span: f64) -> bool {
    let step = span / (t.len() - 1) as f64;
    t.iter().enumerate().all(|(i, x)| (x - t[0] - step * i as f64).abs() < 1e-6 * step)
}

/// How far above the median a sum of squares of so many degrees of freedom is outlying (Wilson and Hilferty 1931).
fn outlying(freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    ((1.0 - spread + OUTLYING * spread.sqrt()) / (1.0 - spread)).powi(3)
}

/// Standard deviation about the mean.
fn scatter(channel: &[f64]) -> f64 {
    let finite = || channel.iter().filter(|y| y.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    (finite().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// The smallest step of a channel of few values: where at least a third of neighbours are equal and the others differ
/// by multiples of one number.
fn quantum(channel: &[f64]) -> Option<f64> {
    let steps = || channel.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| d.is_finite());
    let (equal, all) = steps().fold((0, 0), |(e, n), d| (e + usize::from(d == 0.0), n + 1));
    if 3 * equal < all || equal == all {
        return None;
    }
    let smallest = steps().filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    let multiple = |d: f64| (d / smallest - (d / smallest).round()).abs() < 1e-3 * (d / smallest).max(1.0);
    let odd = steps().filter(|d| *d > 0.0 && !multiple(*d)).count();
    (20 * odd < all - equal).then_some(smallest)
}
