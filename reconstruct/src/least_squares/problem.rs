//! What a fit is to the loop: equations at any point, and how much an outlier counts.

use super::equations::Equations;
use nalgebra::DVector;

/// A loss of residuals z (in standard deviations), as iteratively reweighted least squares takes it. Each has a scale c: residuals far below
/// it count fully, far above it hardly at all.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Loss {
    /// c^2 ln(1 + (z / c)^2), of weight 1 / (1 + (z / c)^2): Cauchy's.
    Cauchy(f64),
    /// Of weight 1 / (1 + (z / c)^4): falls faster, but unlike Tukey's biweight never to 0, so that a start far away still moves.
    Quartic(f64),
}

impl Loss {
    /// The weight of a residual `z` in the equations that has `weight` while it is small.
    pub fn weight(self, weight: f64, z: f64) -> f64 {
        match self {
            Self::Cauchy(scale) => weight / (1.0 + (z / scale).powi(2)),
            Self::Quartic(scale) => weight / (1.0 + (z / scale).powi(4)),
        }
    }
}

#[cfg(feature = "contact")]
impl Loss {
    /// The loss of a residual `z`: z^2 where it is small.
    pub fn of(self, z: f64) -> f64 {
        match self {
            Self::Cauchy(scale) => scale * scale * (z / scale).powi(2).ln_1p(),
            Self::Quartic(scale) => scale * scale * (z / scale).powi(2).atan(),
        }
    }

    /// By how much the loss of a residual `z` exceeds its weighted square, the cost that the equations count. With it costs at different
    /// weights compare.
    pub fn excess(self, z: f64) -> f64 {
        self.of(z) - self.weight(1.0, z) * z * z
    }
}

/// A nonlinear least-squares problem.
pub(crate) trait Problem {
    type Equations: Equations;

    /// The Gauss-Newton equations at `x`. A problem with robust losses weighs its residuals here by what they are at `x`.
    fn equations(&mut self, x: &DVector<f64>) -> Self::Equations;

    /// Called at the start, and at each point where the iteration has settled: weights that stay fixed while it goes on are renewed. False
    /// where nothing has changed, so that the iteration has converged.
    fn reweigh(&mut self, x: &DVector<f64>) -> bool {
        let _ = x;
        false
    }
}

/// A point of the iteration, and the equations that the last step came from or, where the step control has looked ahead, those at the point.
pub(crate) struct Iterate<E> {
    pub x: DVector<f64>,
    pub equations: E,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_weight_is_left_at_the_scale() {
        for loss in [Loss::Cauchy(3.0), Loss::Quartic(3.0)] {
            assert_eq!((loss.weight(1.0, 0.0), loss.weight(1.0, -3.0)), (1.0, 0.5));
            assert!(loss.weight(1.0, 30.0) < 0.01 && loss.weight(1.0, 30.0) > 0.0);
        }
    }
}
