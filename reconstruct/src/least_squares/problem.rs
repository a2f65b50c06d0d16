//! What a fit is to the loop: equations at any point.

use super::equations::Equations;
use nalgebra::DVector;

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
