//! The noise of a channel, estimated from the channel itself.

use super::autoregression::Autoregression;
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
    /// Relative variance of sigma^2 long_run, if the noise is of the model and of order one; 0 of given noise. Kinks and signal make it less certain.
    pub spread: f64,
}

impl ChannelNoise {
    /// White noise of standard deviation `sigma`.
    pub fn white(sigma: f64) -> Self {
        Self { sigma, lag1: 0.0, long_run: 1.0, spread: 0.0 }
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
/// Largest relative growth of the variance of a sample from windows of one length to those of twice the length, and the same in standard deviations: more is
/// signal. The first is what an autoregression of few lags leaves of other noise.
const OTHER_NOISE: f64 = 0.15;
const SIGNAL: f64 = 3.0;
/// Ratio of the residual variances in windows of 16 and 8 samples that correlation and chance explain: AR(1) noise of 0.9 has 1.61.
const CORRELATED: f64 = 2.0;
/// Windows whose residuals exceed the median by this many standard deviations (of a normal variable of the same probability) are left
/// out: they hold a kink, a jump or an outlier.
const OUTLYING: f64 = 4.5;
/// Lags up to this one enter the long-run variance.
const LAGS: usize = 8;
/// Rounds in which the covariances of a process are made those of its windows: each leaves a few per cent of what the last one changed.
const ROUNDS: usize = 8;
/// Correlation times that a window is long at least, where its residuals tell of correlation: a longer one is signal. Steps of bisection for the correlation.
const TIMES: f64 = 4.0;
const BISECTIONS: usize = 20;
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
/// Its correlation is that of an autoregressive process. On 85,000 samples of white noise or AR(1) noise of correlations from -0.4 to 0.45 the standard deviation is right to 1 % and
/// `long_run` to 8 %. Power at longer times (drift, low-pass filters, hum) is added where it
/// exceeds that of the windows and does not grow as a smooth signal does; its `long_run` is right to a factor of 2 or 3. Of 500 samples,
/// sigma sqrt(long_run) is 0.8 to 1.6 times the truth in 80 % of the cases of white noise, and 0.45 to 1.4 times of AR(1) noise of 0.45. The standard deviation is at least the rounding of the largest
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
    let mut best: Option<(Windows, Autoregression)> = None;
    for length in WINDOWS {
        // the shortest windows must do for a short channel; longer ones only where there are many
        if count < length || (best.is_some() && count < 8 * length) {
            break;
        }
        let Some(found) = Windows::of(tau, channel, length) else { break };
        let Some(process) = found.process() else { break };
        if let Some((shorter, before)) = &best {
            let spread = (2.0 / shorter.samples() + 2.0 / found.samples()).sqrt();
            // the three residuals of a shortest window hardly tell of correlation
            let is_signal = if shorter.length == WINDOWS[0] {
                found.white_variance > CORRELATED * shorter.white_variance.max(floor * floor)
            } else {
                let most = 1.0 + OTHER_NOISE.hypot(SIGNAL * spread);
                process.variance() > most * before.variance().max(floor * floor)
            };
            if is_signal {
                break;
            }
        }
        best = Some((found, process));
    }
    let noise = match &best {
        Some((windows, process)) => ChannelNoise {
            sigma: process.variance().sqrt().max(floor),
            lag1: process.lag1(),
            long_run: process.long_run(),
            spread: process.spread(windows.samples()),
        },
        None => ChannelNoise::white(scatter(channel).max(floor)),
    };
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
    ChannelNoise { sigma: variance.sqrt(), long_run: (most * known / variance).max(1.0), ..noise }
}

/// Sums of products of residuals over all good windows of a length.
struct Windows {
    length: usize,
    /// How many are good.
    good: usize,
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
        Some(Self { length, good, white_variance: products[0] / freedom as f64, products })
    }

    /// The process of the noise, from the products, corrected for what the polynomials have taken off; none of exact samples.
    fn process(&self) -> Option<Autoregression> {
        let (lags, rest) = (self.products.len(), Residuals::of(self.length));
        let mut process = self.first_order(&rest)?;
        if lags <= 2 {
            return Some(process);
        }
        let unit = |lag: usize| {
            let mut covariances = vec![0.0; self.length];
            covariances[lag] = 1.0;
            rest.products(&covariances, lags)
        };
        let near = DMatrix::from_columns(&(0..lags).map(unit).collect::<Vec<_>>()).lu();
        // covariances at longer lags than the products tell are those of the process that is found
        for _ in 0..ROUNDS {
            let mut beyond = process.covariances(self.length);
            beyond[..lags].fill(0.0);
            let told = DVector::from_column_slice(&self.products) - rest.products(&beyond, lags);
            // of few windows they may be those of no noise
            let Some(next) = Autoregression::of(near.solve(&told)?.as_slice(), self.samples()) else { break };
            process = next;
        }
        Some(process)
    }

    /// The process of first order with these products at lags 0 and 1, or white noise if that predicts as well.
    fn first_order(&self, rest: &Residuals) -> Option<Autoregression> {
        let products = |rho: f64| {
            let powers = std::iter::successors(Some(1.0), |power| Some(power * rho));
            rest.products(&powers.take(self.length).collect::<Vec<_>>(), 2)
        };
        let largest = 1.0 - TIMES / self.length as f64;
        let (mut low, mut high) = (-largest, largest);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let of_middle = products(middle);
            if of_middle[1] * self.products[0] < self.products[1] * of_middle[0] { low = middle } else { high = middle }
        }
        let rho = 0.5 * (low + high);
        let variance = self.products[0] / products(rho)[0];
        Autoregression::of(&[variance, variance * rho], self.samples())
    }

    /// Independent samples that the residuals are worth.
    fn samples(&self) -> f64 {
        (self.good * (self.length - COLUMNS)) as f64
    }
}

/// What polynomials leave of a window of so many even samples.
struct Residuals {
    /// Orthonormal columns: what they take off.
    taken: DMatrix<f64>,
}

impl Residuals {
    fn of(length: usize) -> Self {
        let t: Vec<f64> = (0..length).map(|i| i as f64).collect();
        let mut bases = Bases::<COLUMNS>::new(length);
        let basis = bases.at(&t);
        Self { taken: DMatrix::from_fn(length, COLUMNS, |i, j| basis[j][i]) }
    }

    /// Expected sums of products of residuals at the first lags, of noise with these covariances at lags 0, 1, ..., one for each sample.
    fn products(&self, covariances: &[f64], count: usize) -> DVector<f64> {
        let length = covariances.len();
        let all = DMatrix::from_fn(length, length, |i, j| covariances[i.abs_diff(j)]);
        let by_taken = &all * &self.taken;
        let both = self.taken.tr_mul(&by_taken);
        // (1 - Q Q') C (1 - Q Q') at i, i + k
        let at = |i: usize, k: usize| {
            let (one, other) = (self.taken.row(i), self.taken.row(i + k));
            all[(i, i + k)] - one.dot(&by_taken.row(i + k)) - other.dot(&by_taken.row(i)) + (one * &both).dot(&other)
        };
        DVector::from_fn(count, |k, _| (0..length - k).map(|i| at(i, k)).sum())
    }
}

/// Standard deviation about the mean.
fn scatter(channel: &[f64]) -> f64 {
    let finite = || channel.iter().filter(|y| y.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    (finite().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}
