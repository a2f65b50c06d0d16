//! Covariance matrices: propagation to functions of the measured numbers, inversion, distances in standard deviations.

use super::number::Number;
#[cfg(feature = "std")]
use nalgebra::{Matrix2, SVector, Vector2};
use nalgebra::{Matrix3, SMatrix};

/// Covariance J C J^T of numbers with the Jacobian J by three measured ones of covariance C.
pub(crate) fn propagate_covariance<T: Number, const N: usize>(
    jacobian: &SMatrix<T, N, 3>,
    covariance: &Matrix3<T>,
) -> SMatrix<T, N, N> {
    jacobian * covariance * jacobian.transpose()
}

/// Variance g^T C g of a number with the gradient g; never negative.
#[cfg(feature = "std")]
pub(crate) fn variance<const N: usize>(gradient: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) -> f64 {
    gradient.dot(&(covariance * gradient)).max(0.0)
}

/// Inverse of a symmetric positive definite matrix.
///
/// Not nalgebra's `try_inverse`: that one tests for a singular matrix, which a covariance with a floor never is, and this is
/// called for each point of a contour.
#[cfg(feature = "std")]
pub(crate) fn inverse(m: &Matrix2<f64>) -> Matrix2<f64> {
    let determinant = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    Matrix2::new(m[(1, 1)], -m[(0, 1)], -m[(1, 0)], m[(0, 0)]) / determinant
}

/// Squared Mahalanobis distance v^T C^-1 v: the squared length of a vector in standard deviations.
#[cfg(feature = "std")]
pub(crate) fn squared_distance(v: &Vector2<f64>, covariance: &Matrix2<f64>) -> f64 {
    v.dot(&(inverse(covariance) * v))
}
