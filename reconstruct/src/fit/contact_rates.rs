//! How a contact changes with the unknowns of a fit, and its uncertainty from that.

use nalgebra::{DMatrix, Matrix2, Vector2};
use rod_core::ContactRate;

/// The rates of a contact by unknowns.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactRates {
    /// Number of the unknown, a factor, and the rate past the contour for the given rod. An unknown may have several.
    pub rates: Vec<(usize, f64, ContactRate)>,
    /// Length of the rod over the given one.
    pub longer: f64,
    /// Number of the error of the length, where it is free, and how it moves the point.
    pub by_length: Option<(usize, Vector2<f64>)>,
}

impl ContactRates {
    /// Covariance of the contact point, m^2.
    pub fn of_point(&self, covariance: &DMatrix<f64>) -> Matrix2<f64> {
        let scaled =
            |(i, share, rate): &(usize, f64, ContactRate)| (*i, Vector2::new(rate.x, rate.y) * *share * self.longer);
        let by: Vec<(usize, Vector2<f64>)> = self.rates.iter().map(scaled).chain(self.by_length).collect();
        let pairs = by.iter().flat_map(|one| by.iter().map(move |other| (one, other)));
        pairs.map(|((i, one), (j, other))| one * other.transpose() * covariance[(*i, *j)]).sum()
    }

    /// Standard deviation of what is linear in the rates of the contact.
    pub fn sigma(&self, covariance: &DMatrix<f64>, of: impl Fn(&ContactRate) -> f64) -> f64 {
        let by: Vec<(usize, f64)> = self.rates.iter().map(|(i, share, rate)| (*i, share * of(rate))).collect();
        let pairs = by.iter().flat_map(|one| by.iter().map(move |other| (one, other)));
        pairs.map(|((i, one), (j, other))| one * other * covariance[(*i, *j)]).sum::<f64>().max(0.0).sqrt()
    }
}
