//! The Gauss-Newton equations of a run.

use nalgebra::{DMatrix, DVector};

/// Gauss-Newton equations of a nonlinear least-squares problem: the matrix J^T W J, the gradient J^T W r and the cost r^T W r of
/// residuals r of weights W.
pub(super) struct Normal {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl Normal {
    /// No residuals yet, for this many unknowns.
    pub fn empty(unknowns: usize) -> Self {
        Self { matrix: DMatrix::zeros(unknowns, unknowns), gradient: DVector::zeros(unknowns), cost: 0.0 }
    }

    /// Adds a residual with its sparse row of derivatives and its standard deviation.
    pub fn add(&mut self, row: &[(usize, f64)], residual: f64, sigma: f64) {
        let weight = sigma.powi(-2);
        for &(i, a) in row {
            self.gradient[i] += a * weight * residual;
            for &(j, b) in row {
                self.matrix[(i, j)] += a * weight * b;
            }
        }
        self.cost += weight * residual * residual;
    }

    /// The matrix scaled to 1 on its diagonal, and the factors of its rows and columns.
    pub fn scaled(&self) -> (DVector<f64>, DMatrix<f64>) {
        let scale = self.matrix.diagonal().map(|d| d.max(f64::MIN_POSITIVE).sqrt().recip());
        let n = scale.len();
        let scaled = DMatrix::from_fn(n, n, |i, j| self.matrix[(i, j)] * scale[i] * scale[j]);
        (scale, scaled)
    }

    /// The Gauss-Newton step, to be subtracted from the unknowns.
    pub fn step(&self) -> Option<DVector<f64>> {
        let (scale, scaled) = self.scaled();
        Some(scaled.cholesky()?.solve(&self.gradient.component_mul(&scale)).component_mul(&scale))
    }
}
