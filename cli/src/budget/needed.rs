//! What sensor, or what rod, would be needed.
//!
//! In units of the rod (E I / L^2, E I / L), a sensor with f times the noise and bias is the same as a rod of 1 / f times the stiffness
//! with the given sensor: shapes do not depend on the stiffness. The information of the samples goes with 1 / f^2, the budgets of bias
//! and drift with f. The phases are taken as identified.

use super::forecast::{Forecast, median_point_sigma};
use nalgebra::{DMatrix, SymmetricEigen};
use vibrissa::reconstruct::Source;

/// The accuracy that is asked for, m.
pub(super) const TARGET: f64 = 1e-4;
/// Smallest and largest factor: beyond, other errors decide, or phases are not identified any more.
const RANGE: (f64, f64) = (0.01, 10.0);
/// Smallest variance of an estimate, in parts of the variance of its budget.
const FINEST: f64 = 1e-12;
/// Halvings of the range.
const HALVINGS: usize = 40;

/// Factors with which the median of the contact points has the standard deviation asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Needed {
    /// Of noise, bias and drift of the sensor.
    pub sensor: Factor,
    /// Of the stiffness of the rod.
    pub stiffness: Factor,
}

/// A factor, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Factor {
    Is(f64),
    /// It is not enough even at the end of the range.
    NotEnough(f64),
    /// It is enough at the other end of the range.
    Always(f64),
}

impl Needed {
    /// None where the budget is empty.
    pub fn of(forecast: &Forecast) -> Option<Self> {
        let count = forecast.sources.len();
        if count == 0 {
            return None;
        }
        let information = map_eigenvalues(forecast.covariance.clone(), |variance| 1.0 / variance.max(FINEST))
            - DMatrix::<f64>::identity(count, count);
        let information = map_eigenvalues(information, |value| value.max(0.0));
        let total = |sensor: f64, stiffer: bool| {
            let prior = |k: usize| match forecast.sources[k].source {
                Source::Friction => 1.0,
                source if source.is_of_scan() => sensor,
                // in E I / L, a clamp yields more to a stiffer rod
                Source::ClampCompliance if stiffer => 1.0 / sensor,
                _ => 1.0,
            };
            let prior = DMatrix::from_fn(count, count, |i, j| if i == j { prior(i).powi(-2) } else { 0.0 });
            let covariance = map_eigenvalues(&information / (sensor * sensor) + prior, |value| 1.0 / value);
            median_point_sigma(&forecast.influence, &covariance).map(|shared| shared.hypot(forecast.noise * sensor))
        };
        let factor = |stiffer: bool| -> Option<Factor> {
            let (mut low, mut high) = RANGE;
            if total(low, stiffer)? > TARGET {
                return Some(Factor::NotEnough(low));
            }
            if total(high, stiffer)? <= TARGET {
                return Some(Factor::Always(high));
            }
            for _ in 0..HALVINGS {
                let middle = (low * high).sqrt();
                if total(middle, stiffer)? > TARGET { high = middle } else { low = middle }
            }
            Some(Factor::Is(low))
        };
        Some(Self { sensor: factor(false)?, stiffness: factor(true)?.inverse() })
    }
}

impl Factor {
    fn inverse(self) -> Self {
        match self {
            Self::Is(factor) => Self::Is(1.0 / factor),
            Self::NotEnough(factor) => Self::NotEnough(1.0 / factor),
            Self::Always(factor) => Self::Always(1.0 / factor),
        }
    }

    /// The factor itself, if there is one.
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Is(factor) => Some(factor),
            _ => None,
        }
    }
}

fn map_eigenvalues(matrix: DMatrix<f64>, of: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(matrix);
    let values = DMatrix::from_diagonal(&eigen.eigenvalues.map(of));
    &eigen.eigenvectors * values * eigen.eigenvectors.transpose()
}
