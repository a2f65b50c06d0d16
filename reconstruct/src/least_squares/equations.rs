//! The Gauss-Newton equations of a problem at a point, as normal equations or as rows.

use nalgebra::{DMatrix, DVector};

/// Linearised least squares.
pub(crate) trait Equations {
    /// The Gauss-Newton step, to be added to the unknowns; none where the equations do not determine it.
    fn step(&self) -> Option<DVector<f64>>;
}

/// Normal equations: the matrix J^T W J, the gradient J^T W r and the cost r^T W r of residuals r of weights W. They need no memory for the
/// rows, but square the condition number.
pub(crate) struct NormalMatrix {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl NormalMatrix {
    /// No residuals yet, for this many unknowns.
    pub fn empty(unknowns: usize) -> Self {
        Self { matrix: DMatrix::zeros(unknowns, unknowns), gradient: DVector::zeros(unknowns), cost: 0.0 }
    }

    /// Adds a residual with its sparse row of derivatives and its standard deviation.
    pub fn add(&mut self, row: &[(usize, f64)], residual: f64, sigma: f64) {
        self.add_weighted(row, residual, sigma.powi(-2));
    }

    /// The same with its weight, the inverse of its variance.
    pub fn add_weighted(&mut self, row: &[(usize, f64)], residual: f64, weight: f64) {
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

    /// The step with the diagonal of the scaled matrix raised by `damping` (Levenberg-Marquardt).
    pub fn damped_step(&self, damping: f64) -> Option<DVector<f64>> {
        let (scale, mut scaled) = self.scaled();
        if damping > 0.0 {
            scaled.set_diagonal(&DVector::repeat(scale.len(), 1.0 + damping));
        }
        Some(-scaled.cholesky()?.solve(&self.gradient.component_mul(&scale)).component_mul(&scale))
    }

    /// By how much a step lets the cost fall in first order, relative to 1 + the cost.
    pub fn relative_fall(&self, step: &DVector<f64>) -> f64 {
        -step.dot(&self.gradient) / (1.0 + self.cost)
    }

    /// Logarithm of the determinant of the matrix; none where it is singular.
    #[cfg(feature = "contact")]
    pub fn log_determinant(&self) -> Option<f64> {
        let (scale, scaled) = self.scaled();
        let root = scaled.cholesky()?;
        Some(2.0 * (root.l_dirty().diagonal().map(f64::ln).sum() - scale.map(f64::ln).sum()))
    }

    /// The covariance of the unknowns, the inverse of the matrix; none where it is singular.
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let (scale, scaled) = self.scaled();
        let inverse = scaled.cholesky()?.inverse();
        Some(DMatrix::from_fn(scale.len(), scale.len(), |i, j| inverse[(i, j)] * scale[i] * scale[j]))
    }
}

impl Equations for NormalMatrix {
    fn step(&self) -> Option<DVector<f64>> {
        self.damped_step(0.0)
    }
}

/// Rows of weighted derivatives and negative weighted residuals, for a QR decomposition: where the condition number squared would leave no
/// digits. The decomposition is made at the first step.
pub(crate) struct Rows {
    /// R of the decomposition: R^T R is the matrix of the normal equations.
    pub triangle: DMatrix<f64>,
    /// Q^T times the right-hand side.
    right: DVector<f64>,
}

impl Rows {
    /// The rows J and right-hand side -r, both weighted.
    pub fn from_rows(rows: DMatrix<f64>, mut right: DVector<f64>) -> Self {
        let unknowns = rows.ncols();
        let decomposed = rows.qr();
        decomposed.q_tr_mul(&mut right);
        Self { triangle: decomposed.r(), right: right.rows(0, unknowns).into_owned() }
    }
}

impl Equations for Rows {
    fn step(&self) -> Option<DVector<f64>> {
        self.triangle.solve_upper_triangular(&self.right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_normal_equations_give_one_step() {
        let rows = DMatrix::from_row_slice(4, 2, &[1.0, 2.0, 0.5, -1.0, 3.0, 0.1, -0.2, 0.7]);
        let right = DVector::from_column_slice(&[0.3, -1.0, 2.0, 0.4]);
        let mut normal = NormalMatrix::empty(2);
        for k in 0..4 {
            normal.add(&[(0, 0.5 * rows[(k, 0)]), (1, 0.5 * rows[(k, 1)])], -0.5 * right[k], 0.5);
        }
        let (a, b) = (normal.step().unwrap(), Rows::from_rows(rows.clone(), right).step().unwrap());
        assert!((a - b).amax() < 1e-14);
        let inverse = (rows.transpose() * rows).try_inverse().unwrap();
        assert!((normal.covariance().unwrap() - inverse).amax() < 1e-14);
    }
}
