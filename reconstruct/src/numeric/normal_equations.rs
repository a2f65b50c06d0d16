//! Linear least squares by normal equations.

use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// Normal equations of a linear least-squares problem with N unknowns for each of M right-hand sides.
///
/// They need no memory for the rows, but square the condition number: what has to be exact is corrected by a second solution
/// on the residuals.
#[derive(Clone, Debug)]
pub(crate) struct NormalEquations<const N: usize, const M: usize> {
    /// Sum of w a a^T over the rows a of weight w; its lower triangle only.
    lower: SMatrix<f64, N, N>,
    /// Sum of w a y^T over the measured values y.
    pub right: SMatrix<f64, N, M>,
}

impl<const N: usize, const M: usize> Default for NormalEquations<N, M> {
    fn default() -> Self {
        Self { lower: SMatrix::zeros(), right: SMatrix::zeros() }
    }
}

impl<const N: usize, const M: usize> NormalEquations<N, M> {
    /// Adds a row with its measured values; `weight` is the inverse of their variance.
    pub fn add(&mut self, row: &SVector<f64, N>, values: &SVector<f64, M>, weight: f64) {
        for i in 0..N {
            let weighted = weight * row[i];
            for j in 0..=i {
                self.lower[(i, j)] += weighted * row[j];
            }
            for c in 0..M {
                self.right[(i, c)] += weighted * values[c];
            }
        }
    }

    /// Sum of w a_k^2 over the rows.
    pub fn square(&self, k: usize) -> f64 {
        self.lower[(k, k)]
    }

    /// The Cholesky factor; none where the rows do not determine the unknowns.
    pub fn factor(&self) -> Option<Cholesky<f64, Const<N>>> {
        // of a symmetric matrix nalgebra reads the lower triangle only
        self.lower.cholesky()
    }

    /// The same for the first K unknowns alone.
    pub fn factor_of_first<const K: usize>(&self) -> Option<Cholesky<f64, Const<K>>> {
        self.lower.fixed_view::<K, K>(0, 0).into_owned().cholesky()
    }
}
