//! Noise as an autoregressive process: a sample is a sum of multiples of those before it and of white noise.

/// The process that explains covariances.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Autoregression {
    /// Covariances at lags 0, 1, ..., up to the order.
    covariances: Vec<f64>,
    /// Multiples of the samples before, the last one first.
    coefficients: Vec<f64>,
    /// Variance of the white noise.
    innovation: f64,
}

impl Autoregression {
    /// The process of the order that predicts best (Akaike 1974), at most the number of lags, by the recursion of Levinson (1947) and Durbin (1960).
    /// `covariances` are those at lags 0, 1, ..., found from so many independent samples. None without variance.
    pub fn of(covariances: &[f64], samples: f64) -> Option<Self> {
        let variance = *covariances.first().filter(|variance| **variance > 0.0)?;
        let (mut coefficients, mut innovation): (Vec<f64>, f64) = (Vec::new(), variance);
        let criterion = |order: usize, innovation: f64| samples * innovation.ln() + 2.0 * order as f64;
        let mut best = (criterion(0, innovation), coefficients.clone(), innovation);
        for lag in 1..covariances.len() {
            let predicted: f64 = coefficients.iter().zip(covariances[1..lag].iter().rev()).map(|(a, c)| a * c).sum();
            let partial = (covariances[lag] - predicted) / innovation;
            // of no process: an accident of the estimate
            if !(-1.0 < partial && partial < 1.0) {
                break;
            }
            let mirrored: Vec<f64> = coefficients.iter().rev().copied().collect();
            coefficients.iter_mut().zip(mirrored).for_each(|(a, other)| *a -= partial * other);
            coefficients.push(partial);
            innovation *= 1.0 - partial * partial;
            let this = criterion(lag, innovation);
            if this < best.0 {
                best = (this, coefficients.clone(), innovation);
            }
        }
        let (_, coefficients, innovation) = best;
        Some(Self { covariances: covariances[..=coefficients.len()].to_vec(), coefficients, innovation })
    }

    /// Variance of a sample.
    pub fn variance(&self) -> f64 {
        self.covariances[0]
    }

    /// Correlation of neighbouring samples.
    pub fn lag1(&self) -> f64 {
        self.covariances.get(1).map_or(0.0, |lag1| lag1 / self.variance())
    }

    /// Variance of the mean of a long block of b samples, times b, over the variance of a sample.
    pub fn long_run(&self) -> f64 {
        let rest = 1.0 - self.coefficients.iter().sum::<f64>();
        self.innovation / self.variance() / (rest * rest)
    }

    /// Relative variance of `variance() * long_run()` where the covariances are of so many independent samples. The order is taken for known, but for
    /// that of white noise: a weak correlation is not seen.
    pub fn spread(&self, samples: f64) -> f64 {
        // of the first order (the spectral density at frequency 0): 2 / n of the innovation, 4 (1 + a) / (1 - a) / n of the coefficient
        let order = self.coefficients.len().max(1) as f64;
        let sum = self.coefficients.iter().sum::<f64>().clamp(-0.99, 0.99);
        (2.0 + 4.0 * order * (1.0 + sum) / (1.0 - sum)) / samples.max(1.0)
    }

    /// Covariances at lags from 0 on.
    pub fn covariances(&self, count: usize) -> Vec<f64> {
        let mut found = self.covariances.clone();
        found.truncate(count);
        while found.len() < count {
            let next = self.coefficients.iter().zip(found.iter().rev()).map(|(a, c)| a * c).sum();
            found.push(next);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_process_of_exact_covariances_is_found_again() {
        let first = Autoregression::of(&[4.0, 2.0, 1.0, 0.5], 1e4).unwrap();
        assert_eq!((first.coefficients.len(), first.variance(), first.lag1()), (1, 4.0, 0.5));
        // (1 + 0.5) / (1 - 0.5)
        assert!((first.long_run() - 3.0).abs() < 1e-12, "{first:?}");
        assert_eq!(first.covariances(5), [4.0, 2.0, 1.0, 0.5, 0.25]);
        let white = Autoregression::of(&[1.0, 0.01, -0.01], 100.0).unwrap();
        assert_eq!((white.long_run(), white.lag1()), (1.0, 0.0));
        // x_k = 0.5 x_(k-1) + 0.3 x_(k-2) + e: rho_1 = 0.5 / 0.7, rho_2 = 0.5 rho_1 + 0.3, innovation 1 - 0.5 rho_1 - 0.3 rho_2
        let rho1 = 0.5 / 0.7;
        let rho2 = 0.5 * rho1 + 0.3;
        let rho3 = 0.5 * rho2 + 0.3 * rho1;
        let second = Autoregression::of(&[1.0, rho1, rho2, rho3], 1e4).unwrap();
        let innovation = 1.0 - 0.5 * rho1 - 0.3 * rho2;
        assert!((second.long_run() - innovation / 0.04).abs() < 1e-9, "{second:?}");
        assert!(Autoregression::of(&[0.0, 0.0], 10.0).is_none());
    }
}
