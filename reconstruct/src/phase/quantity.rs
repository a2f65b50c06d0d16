//! A number with its standard deviation.

/// A quantity that a phase requires to vanish, and its standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantity {
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

impl Quantity {
    /// A quantity of infinite uncertainty.
    pub const UNKNOWN: Self = Self { value: 0.0, sigma: f64::INFINITY };

    /// From a variance, and an error that it has in any case.
    pub(super) fn new(value: f64, variance: f64, floor: f64) -> Self {
        Self { value, sigma: (variance + floor * floor).sqrt() }
    }

    /// Value over standard deviation.
    pub fn z(&self) -> f64 {
        self.value / self.sigma
    }

    /// Log of the odds of "it is 0" against "it is spread about 0 by this standard deviation": 0 where the noise is much wider.
    pub(super) fn vanishes(&self, spread: f64) -> f64 {
        if self.sigma.is_infinite() {
            return 0.0;
        }
        let wide = self.sigma.hypot(spread);
        (wide / self.sigma).ln() - 0.5 * (self.z() * self.z() - (self.value / wide).powi(2))
    }

    /// Log of the likelihood that it is not positive.
    pub(super) fn not_positive(&self) -> f64 {
        let z = self.z().max(0.0);
        -0.5 * z * z
    }
}
