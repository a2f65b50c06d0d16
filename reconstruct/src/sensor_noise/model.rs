//! The errors of a sensor.

use crate::scan::noise_estimate::ChannelNoise;
use rod_core::Reactions;

/// Why a noise model is not possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// A number that is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Value {
        /// Which one, as in `white.f0x` or `crosstalk[1][3]`, rows and columns counted from 1.
        field: String,
        /// Its value as given.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}

/// A sensor that is not perfect, SI units. Everything is zero by default, and a model of zeros changes nothing.
///
/// A sample r = (f0x, f0y, m0z) becomes, in this order,
///
/// 1. (I + diag(gain) + crosstalk) r + offset,
/// 2. plus white noise, AR(1) noise and a random walk, each channel on its own,
/// 3. rounded to whole multiples of the quantum,
/// 4. or it is lost in a dropout.
///
/// White noise and AR(1) are stationary from the first sample on; the walk starts from zero there. All of them go on
/// while samples are lost. Correlation, walk and dropouts count samples, not seconds: a walk of w per square root of a
/// second has steps of w / sqrt(rate).
///
/// With the feature `serde` it deserialises from tables of the same names ([`white`](Self::white) and so on) with the channels as fields;
/// `force` in place of `f0x` and `f0y` stands for both.
///
/// ```
/// use rod_core::Reactions;
/// use rod_reconstruct::NoiseModel;
/// let model: NoiseModel = toml::from_str("
///     white = { force = 2.5e-3, m0z = 6e-5 } # N, N m
///     quantum = { m0z = 1e-6 }
///     dropout = { probability = 0.01 }
/// ")?;
/// let mut sensor = model.generator(42)?;
/// let clean = Reactions { f0x: 0.1, f0y: -0.2, m0z: 5e-3 };
/// let felt = (0..1000).filter_map(|_| sensor.sample(clean));
/// let worst = felt.map(|felt| (felt.f0x - clean.f0x).abs()).fold(0.0, f64::max);
/// assert!(worst > 5e-3 && worst < 15e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NoiseModel {
    /// Relative error of the gain: 0.01 reads 1 % too much.
    pub gain: Reactions,
    /// What each channel (row) gets from each (column), both in the order f0x, f0y, m0z. The unit is 1/m for a force from the moment,
    /// m for the moment from a force, and 1 otherwise.
    pub crosstalk: [[f64; 3]; 3],
    /// Reading without a load, N and N m.
    pub offset: Reactions,
    /// Standard deviation of white noise, N and N m.
    pub white: Reactions,
    /// Noise that is correlated from sample to sample.
    pub ar1: Ar1,
    /// Standard deviation of the step from one sample to the next, N and N m.
    pub random_walk: Reactions,
    /// Quantum to whose multiples readings are rounded, N and N m; 0 for none.
    pub quantum: Reactions,
    /// Samples that are lost.
    pub dropout: Dropout,
}

/// First-order autoregressive noise: e_k+1 = rho e_k + sigma sqrt(1 - rho^2) z, with z standard normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ar1 {
    /// Standard deviation sigma of a sample, N and N m.
    pub sigma: Reactions,
    /// Correlation rho of neighbouring samples, between -1 and 1.
    pub correlation: f64,
}

/// Samples that are lost, one by one or several in a row. The lengths of the gaps are geometrically distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dropout {
    /// Chance of a sample to be lost: the share of lost samples in the long run, from 0 to below 1.
    pub probability: f64,
    /// Mean number of samples lost in a row, at least 1 and at least probability / (1 - probability), for between two
    /// gaps one sample arrives. None: each is lost or not on its own.
    pub mean_length: Option<f64>,
}

impl NoiseModel {
    /// Standard deviation of one reading (N, N m) about what gain, crosstalk and offset make of the truth: of white and
    /// AR(1) noise together with the quantum's q / sqrt(12). The random walk, which has none, is left out.
    ///
    /// ```
    /// use rod_core::Reactions;
    /// use rod_reconstruct::NoiseModel;
    /// let model = NoiseModel { white: Reactions { f0x: 3.0, ..Default::default() }, ..Default::default() };
    /// assert_eq!(model.sigma(), Reactions { f0x: 3.0, f0y: 0.0, m0z: 0.0 });
    /// ```
    pub fn sigma(&self) -> Reactions {
        let sum = |white: f64, ar1: f64, quantum: f64| white.hypot(ar1).hypot(quantum / 12_f64.sqrt());
        let (white, ar1, quantum) = (&self.white, &self.ar1.sigma, &self.quantum);
        Reactions {
            f0x: sum(white.f0x, ar1.f0x, quantum.f0x),
            f0y: sum(white.f0y, ar1.f0y, quantum.f0y),
            m0z: sum(white.m0z, ar1.m0z, quantum.m0z),
        }
    }

    /// The noise of f0x, f0y (N) and m0z (N m) as a reconstruction takes it: white and AR(1) noise with the quantum's q / sqrt(12). The
    /// random walk, which has no standard deviation, is left out.
    ///
    /// ```
    /// use rod_core::Reactions;
    /// use rod_reconstruct::{Ar1, NoiseModel};
    /// let sigma = Reactions { f0x: 3.0, ..Default::default() };
    /// let model = NoiseModel { ar1: Ar1 { sigma, correlation: 0.5 }, ..Default::default() };
    /// let noise = model.channels()[0];
    /// assert_eq!((noise.sigma, noise.lag1, noise.long_run), (3.0, 0.5, 3.0));
    /// ```
    pub fn channels(&self) -> [ChannelNoise; 3] {
        let of = |r: Reactions| [r.f0x, r.f0y, r.m0z];
        let (sigma, ar1, rho) = (of(self.sigma()), of(self.ar1.sigma), self.ar1.correlation);
        std::array::from_fn(|c| {
            let share = if sigma[c] > 0.0 { (ar1[c] / sigma[c]).powi(2) } else { 0.0 };
            let long_run = 1.0 + share * ((1.0 + rho) / (1.0 - rho) - 1.0);
            ChannelNoise { sigma: sigma[c], lag1: share * rho, long_run, spread: 0.0 }
        })
    }

    /// Checks that every number is possible.
    ///
    /// # Errors
    /// [`NoiseError::Value`] with the field: a number that is not finite, a negative standard deviation or quantum, a
    /// correlation that is not between -1 and 1, a dropout that cannot be.
    pub fn check(&self) -> Result<(), NoiseError> {
        for (table, channels) in [("gain", &self.gain), ("offset", &self.offset)] {
            for (channel, value) in named(channels) {
                require(value.is_finite(), || format!("{table}.{channel}"), value, "a finite number")?;
            }
        }
        for (row, entries) in self.crosstalk.iter().enumerate() {
            for (column, &value) in entries.iter().enumerate() {
                let field = || format!("crosstalk[{}][{}]", row + 1, column + 1);
                require(value.is_finite(), field, value, "a finite number")?;
            }
        }
        let spreads = [
            ("white", &self.white),
            ("ar1", &self.ar1.sigma),
            ("random_walk", &self.random_walk),
            ("quantum", &self.quantum),
        ];
        for (table, channels) in spreads {
            for (channel, value) in named(channels) {
                let possible = value.is_finite() && value >= 0.0;
                require(possible, || format!("{table}.{channel}"), value, "a finite number that is not negative")?;
            }
        }
        let rho = self.ar1.correlation;
        require(rho.abs() < 1.0, || "ar1.correlation".into(), rho, "a number between -1 and 1, without these two")?;
        self.dropout.check()
    }
}

impl Dropout {
    fn check(&self) -> Result<(), NoiseError> {
        let Self { probability, mean_length } = *self;
        let field = || "dropout.probability".to_owned();
        require((0.0..1.0).contains(&probability), field, probability, "a number from 0 to below 1")?;
        let Some(length) = mean_length else { return Ok(()) };
        let field = || "dropout.mean_length".to_owned();
        require(length.is_finite() && length >= 1.0, field, length, "a number of samples, at least 1")?;
        let shortest = probability / (1.0 - probability);
        require(length >= shortest, field, length, "at least probability / (1 - probability)")
    }

    /// Chance that a sample is lost after one that arrived, and after one that was lost.
    pub(super) fn chances(&self) -> (f64, f64) {
        match self.mean_length {
            None => (self.probability, self.probability),
            Some(length) => (self.probability / ((1.0 - self.probability) * length), 1.0 - 1.0 / length),
        }
    }
}

fn named(channels: &Reactions) -> [(&'static str, f64); 3] {
    [("f0x", channels.f0x), ("f0y", channels.f0y), ("m0z", channels.m0z)]
}

fn require(
    possible: bool,
    field: impl FnOnce() -> String,
    value: f64,
    expected: &'static str,
) -> Result<(), NoiseError> {
    if possible { Ok(()) } else { Err(NoiseError::Value { field: field(), value, expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(f0x: f64, f0y: f64, m0z: f64) -> Reactions {
        Reactions { f0x, f0y, m0z }
    }

    #[test]
    fn refuses_what_is_no_noise_and_says_where() {
        let zero = NoiseModel::default;
        let mut crosstalk = [[0.0; 3]; 3];
        crosstalk[0][2] = f64::INFINITY;
        let lost = |probability, mean_length| NoiseModel { dropout: Dropout { probability, mean_length }, ..zero() };
        let remembers =
            |correlation| NoiseModel { ar1: Ar1 { sigma: one(1.0, 1.0, 1.0), correlation }, ..NoiseModel::default() };
        for (model, message) in [
            (
                NoiseModel { white: one(-1.0, 0.0, 0.0), ..zero() },
                "white.f0x is -1, expected a finite number that is not",
            ),
            (NoiseModel { white: one(0.0, f64::NAN, 0.0), ..zero() }, "white.f0y is NaN, expected a finite"),
            (NoiseModel { random_walk: one(0.0, 0.0, -2.0), ..zero() }, "random_walk.m0z is -2, "),
            (NoiseModel { quantum: one(0.0, f64::INFINITY, 0.0), ..zero() }, "quantum.f0y is inf, "),
            (NoiseModel { gain: one(0.0, f64::NAN, 0.0), ..zero() }, "gain.f0y is NaN, expected a finite number"),
            (NoiseModel { offset: one(f64::INFINITY, 0.0, 0.0), ..zero() }, "offset.f0x is inf"),
            (NoiseModel { crosstalk, ..zero() }, "crosstalk[1][3] is inf, expected a finite number"),
            (
                NoiseModel { ar1: Ar1 { sigma: one(0.0, -1.0, 0.0), correlation: 0.0 }, ..zero() },
                "ar1.f0y is -1, expected",
            ),
            (remembers(1.0), "ar1.correlation is 1, expected a number between -1 and 1, without these two"),
            (remembers(-1.5), "ar1.correlation is -1.5"),
            (remembers(f64::NAN), "ar1.correlation is NaN"),
            (lost(1.0, None), "dropout.probability is 1, expected a number from 0 to below 1"),
            (lost(-0.1, None), "dropout.probability is -0.1"),
            (lost(f64::NAN, None), "dropout.probability is NaN"),
            (lost(0.1, Some(0.5)), "dropout.mean_length is 0.5, expected a number of samples, at least 1"),
            (lost(0.9, Some(2.0)), "dropout.mean_length is 2, expected at least probability / (1 - probability)"),
        ] {
            let error = model.generator(0).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        assert!(lost(0.9, Some(9.1)).check().is_ok());
    }

    #[test]
    fn standard_deviations_add_in_squares() {
        let model = NoiseModel {
            white: one(3.0, 0.0, 1.0),
            ar1: Ar1 { sigma: one(4.0, 2.0, 0.0), correlation: 0.5 },
            quantum: one(0.0, 0.0, 12_f64.sqrt()),
            random_walk: one(7.0, 7.0, 7.0),
            ..NoiseModel::default()
        };
        let sigma = model.sigma();
        for (found, expected) in [(sigma.f0x, 5.0), (sigma.f0y, 2.0), (sigma.m0z, 2_f64.sqrt())] {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
