//! What is known of contour and errors before: errors within their budgets, points about their start, and a smooth contour.

use super::curve::{Curve, Dependent};
use crate::least_squares::{Equations, Loss, NormalMatrix};
use nalgebra::{DMatrix, DVector};

/// Loss of changes of curvature, of this scale in standard deviations. Larger: vertices are rounded; smaller: noise makes vertices.
const LOSS: Loss = Loss::Cauchy(3.0);
/// Ratio of two standard deviations of the change of curvature of which one is chosen.
const STEP: f64 = 1.25;

/// The prior at some unknowns, for any standard deviation `bend` of the change of curvature.
pub(super) struct Prior<'x> {
    x: &'x DVector<f64>,
    /// Standard deviations of the unknowns.
    sigmas: Vec<f64>,
    bends: Vec<Dependent>,
}

impl<'x> Prior<'x> {
    /// For the unknowns `x` of a contour, the offsets of its points and then errors in standard deviations of their budget.
    pub fn of(x: &'x DVector<f64>, curve: &Curve) -> Self {
        let errors = std::iter::repeat(1.0);
        Self { x, sigmas: curve.sigmas().chain(errors).take(x.len()).collect(), bends: curve.bends() }
    }

    pub fn at(&self, bend: f64) -> NormalMatrix {
        let mut prior = self.weighted(bend, |z| LOSS.weight(1.0, z));
        prior.cost += self.bends.iter().map(|(value, _)| LOSS.excess(value / bend)).sum::<f64>();
        prior
    }

    fn weighted(&self, bend: f64, weight: impl Fn(f64) -> f64) -> NormalMatrix {
        let mut prior = NormalMatrix::empty(self.x.len());
        self.sigmas.iter().enumerate().for_each(|(i, sigma)| prior.add(&[(i, 1.0)], self.x[i], *sigma));
        for (value, rates) in &self.bends {
            let row: Vec<(usize, f64)> = rates.iter().map(|(i, rate)| (*i, rate / bend)).collect();
            prior.add_weighted(&row, value / bend, weight(value / bend));
        }
        prior
    }

    /// The standard deviation of changes of curvature that explains those of a contour better than `bend`: the mean of their squares and of what is not known
    /// of them (one step of expectation maximisation, Dempster, Laird and Rubin 1977), robust against vertices.
    pub fn expected(&self, bend: f64, covariance: &DMatrix<f64>) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (value, rates) in &self.bends {
            let with = |(i, rate): &(usize, f64)| {
                rates.iter().map(|(j, other)| rate * covariance[(*i, *j)] * other).sum::<f64>()
            };
            let unknown: f64 = rates.iter().map(with).sum();
            let weight = LOSS.weight(1.0, value / bend);
            sum += weight * (value * value + unknown);
            weights += weight;
        }
        if weights > 0.0 { (sum / weights).sqrt() } else { bend }
    }

    /// -2 times the logarithm of the volume of what is known of the unknowns over that of what was known before: the price of each unknown that the recording
    /// determines, in units of the cost. Cost and price are -2 times the logarithm of the evidence of a contour, by Laplace's method (MacKay 1992).
    /// `equations` are those of recording and prior.
    pub fn price(&self, bend: f64, equations: &NormalMatrix) -> Option<f64> {
        // a density as it is normalised: without the weights of outliers
        Some(equations.log_determinant()? - self.weighted(bend, |_| 1.0).log_determinant()?)
    }

    /// The standard deviation of changes of curvature, from `bend` down to `least`, of the greatest evidence as far as the equations with `bend` tell: for
    /// straight parts the [`expected`](Self::expected) one comes down to it slowly.
    pub fn straightest(&self, bend: f64, least: f64, equations: &NormalMatrix) -> f64 {
        let prior = self.at(bend);
        let (data, slope) = (&equations.matrix - prior.matrix, &equations.gradient - prior.gradient);
        let penalty = |bend: f64| {
            let NormalMatrix { matrix, gradient, cost } = self.at(bend);
            let all = NormalMatrix { matrix: &data + matrix, gradient: &slope + gradient, cost };
            Some(cost + all.step()?.dot(&all.gradient) + self.price(bend, &all)?)
        };
        let mut best = (f64::INFINITY, bend);
        for bend in std::iter::successors(Some(bend), |bend| Some(bend / STEP)).take_while(|bend| *bend >= least) {
            match penalty(bend) {
                Some(penalty) if penalty < best.0 => best = (penalty, bend),
                _ => break,
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::super::curve::Node;
    use super::*;
    use nalgebra::Vector2;

    fn line(count: usize) -> Curve {
        let node = |k: usize| Node::smooth(Vector2::new(0.01 * k as f64, 0.0), 0.03);
        Curve::through(&[(0..count).map(node).collect()]).unwrap()
    }

    /// The equations of points that are measured with this standard deviation, and of the prior.
    fn equations(prior: &Prior<'_>, bend: f64, sigma: f64) -> NormalMatrix {
        let mut all = prior.at(bend);
        (0..prior.x.len()).for_each(|i| all.add(&[(i, 1.0)], prior.x[i], sigma));
        all
    }

    #[test]
    fn the_evidence_is_the_density_of_what_was_measured() {
        let x = DVector::zeros(6);
        let prior = Prior::of(&x, &line(6));
        let sigma = 1e-4;
        for bend in [3.0, 30.0, 300.0] {
            // of 0 at all points: their covariance is that of the prior and of the noise
            let covariance = prior.at(bend).covariance().unwrap() + DMatrix::identity(6, 6) * sigma * sigma;
            let expected = covariance.determinant().ln() - 12.0 * sigma.ln();
            let found = prior.price(bend, &equations(&prior, bend, sigma)).unwrap();
            assert!((found - expected).abs() < 1e-6, "{bend}: {found} {expected}");
        }
    }

    #[test]
    fn a_straight_contour_is_known_to_be_straight() {
        let x = DVector::zeros(12);
        let prior = Prior::of(&x, &line(12));
        let found = prior.straightest(1e3, 1.0, &equations(&prior, 1e3, 1e-4));
        assert!(found < 1.3, "{found}");
    }
}
