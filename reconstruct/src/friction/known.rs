//! What is known of friction before a reconstruction.

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
