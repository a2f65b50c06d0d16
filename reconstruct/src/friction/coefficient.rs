//! The coefficient of friction: what is known before a reconstruction, and what a scan says.

use crate::numeric::CHANCE;

/// Standard deviation of the coefficient of friction about that of the plateau, where nothing is known of it: as good as anything.
pub(crate) const ANY: f64 = 0.3;

/// What is known of friction before a reconstruction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Friction {
    /// There is none.
    #[default]
    None,
    /// A coefficient, 0 or larger, and its standard deviation. Its direction is that which makes the scan likelier.
    Known {
        /// The coefficient of friction.
        mu: f64,
        /// Its standard deviation; the scan improves on it.
        sigma: f64,
    },
    /// Nothing: the scan tells it, each pass on its own.
    Estimate,
}

impl Friction {
    /// Standard deviation of the coefficient before the scan is seen, as in [`Budget::friction`](crate::Budget::friction): 0 without friction,
    /// and 0.3 where nothing is known.
    pub fn sigma(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Known { sigma, .. } => sigma,
            Self::Estimate => ANY,
        }
    }

    /// The number that is not possible, if one is.
    pub(crate) fn fault(self) -> Option<f64> {
        match self {
            Self::Known { mu, sigma } => [mu, sigma].into_iter().find(|value| !(value.is_finite() && *value >= 0.0)),
            _ => None,
        }
    }
}

/// Logarithm of the factor by which a scan must be likelier with friction than without: very strong evidence (Jeffreys 1961, appendix B).
const DECISIVE: f64 = 10.0;
/// How much errors of an ordinary laboratory let a coefficient seem to vary: 0.01.
pub(crate) const SPREAD: f64 = 0.015;

/// What a pass of a recording tells of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrictionEstimate {
    /// The coefficient that was used: positive where friction draws the rod from its clamp towards its tip, as on a rod that is
    /// drawn back over its contacts, negative where the rod is pushed on.
    pub mu: f64,
    /// Its standard deviation. Where errors that all samples share are estimated, it contains that they may be mistaken for friction.
    pub sigma: f64,
    /// Standard deviation by the noise alone, as if all else were known.
    pub sigma_of_noise: f64,
    /// How far K / (2 |F|) along tangential contacts is from one value, in standard deviations of its noise (root mean square, or that of
    /// another part of the path): 1 where the coefficient is the same along the pass.
    pub scatter: f64,
    /// How much the coefficient varies along the pass beyond the noise (standard deviation), or how far that of another part of the tangential
    /// path, a tenth at least, is off.
    pub spread: f64,
    /// Logarithm of the likelihood of the pass with friction over that without, each with the errors that explain it best. Where friction was
    /// asked for, those without it are found from few places: where it is strong, this number is exact to a tenth.
    pub gain: f64,
    /// Share of the tangential path along which the rod slides the other way than this sign of friction asks for.
    pub against: f64,
    /// What the pass tells without regard to a coefficient that was given; none where none was.
    pub alone: Option<FrictionAlone>,
}

/// What a pass of a recording tells of friction on its own, where a coefficient was given.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrictionAlone {
    /// The coefficient, with the sign of [`FrictionEstimate::mu`], and its standard deviation, as there.
    pub mu: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// The coefficient that was given, with its sign.
    pub given: f64,
    /// How far they are apart, in standard deviations of both.
    pub deviation: f64,
}

impl FrictionAlone {
    /// Of a coefficient that was `given` with its standard deviation.
    pub(crate) fn of(found: &FrictionEstimate, given: f64, sigma: f64) -> Self {
        let deviation = (found.mu - given).abs() / found.sigma.hypot(sigma);
        Self { mu: found.mu, sigma: found.sigma, given, deviation }
    }

    /// Whether the pass contradicts the coefficient that was given: by more than four standard deviations, and by more than errors of an
    /// ordinary laboratory let a coefficient seem to vary.
    pub fn contradicts(&self) -> bool {
        self.deviation > CHANCE && (self.mu - self.given).abs() > SPREAD
    }
}

impl FrictionEstimate {
    /// Whether the friction is significant: the coefficient exceeds four times [`sigma_of_noise`](Self::sigma_of_noise), and the likelihood ratio
    /// is very strong evidence against a pass without friction.
    pub fn is_significant(&self) -> bool {
        self.mu.abs() > CHANCE * self.sigma_of_noise && self.gain > DECISIVE
    }

    /// Whether the systematic errors do not explain the friction of the pass: the coefficient exceeds four times [`sigma`](Self::sigma).
    pub fn is_identified(&self) -> bool {
        self.mu.abs() > CHANCE * self.sigma && self.gain > DECISIVE
    }
}
