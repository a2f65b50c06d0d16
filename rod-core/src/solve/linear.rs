//! Inverse of a small dense matrix, on the stack up to the dimension of eight contacts.

use nalgebra::{DMatrix, SMatrix};

/// Writes the inverse of the column-major `dimension` x `dimension` matrix `a` to `inverse`; false where it has none.
///
/// An explicit inverse, not a factorisation: at these sizes it costs about as much, several right-hand sides follow, and it
/// gives the condition number exactly. Newton's method corrects its rounding. Closed forms up to dimension 4, then Gauss and
/// Jordan's with columns of known length, which vectorises.
pub(crate) fn invert(dimension: usize, a: &[f64], inverse: &mut [f64]) -> bool {
    macro_rules! of_known_size {
        (closed: $($m:literal)*; columns: $($n:literal)*) => {
            match dimension {
                0 => true,
                $($m => {
                    let found = SMatrix::<f64, $m, $m>::from_column_slice(a).try_inverse();
                    found.is_some_and(|m| { inverse.copy_from_slice(m.as_slice()); true })
                })*
                $($n => {
                    inverse.copy_from_slice(a);
                    gauss_jordan::<$n>(inverse.as_chunks_mut().0)
                })*
                n => {
                    let found = DMatrix::from_column_slice(n, n, a).try_inverse();
                    found.is_some_and(|m| { inverse.copy_from_slice(m.as_slice()); true })
                }
            }
        };
    }
    // 3 n of a boundary-value problem and 3 n + 1 of its continuation along a path, n <= 8; one more for each of up to two contacts that stick
    of_known_size!(closed: 1 2 3 4; columns: 5 6 7 8 9 10 11 12 13 15 16 18 19 21 22 24 25)
        && inverse.iter().all(|v| v.is_finite())
}

/// Inverts a matrix, given by its columns, in place, with partial pivoting; false where a pivot vanishes.
fn gauss_jordan<const N: usize>(columns: &mut [[f64; N]]) -> bool {
    let mut pivots = [0; N];
    for k in 0..N {
        let mut own = columns[k];
        let pivot = (k + 1..N).fold(k, |best, i| if own[i].abs() > own[best].abs() { i } else { best });
        let scale = 1.0 / own[pivot];
        // no pivot at all, or no number
        if !scale.is_finite() {
            return false;
        }
        pivots[k] = pivot;
        if pivot != k {
            own.swap(k, pivot);
            columns.iter_mut().for_each(|column| column.swap(k, pivot));
        }
        own[k] = 0.0;
        for column in &mut *columns {
            let factor = scale * column[k];
            for (entry, pivotal) in column.iter_mut().zip(&own) {
                *entry -= factor * pivotal;
            }
            column[k] = factor;
        }
        columns[k] = own.map(|entry| -scale * entry);
        columns[k][k] = scale;
    }
    // rows that changed places are columns of the inverse
    (0..N).rev().for_each(|k| columns.swap(k, pivots[k]));
    true
}

/// Largest column sum of the column-major square matrix `a`.
pub(crate) fn norm_1(dimension: usize, a: &[f64]) -> f64 {
    a.chunks_exact(dimension.max(1)).map(|column| column.iter().map(|v| v.abs()).sum()).fold(0.0, f64::max)
}

/// Condition number in the 1-norm with unknowns in their natural sizes.
pub(crate) fn weighted_condition(matrix: &[f64], inverse: &[f64], weights: &[f64]) -> f64 {
    let size = weights.len();
    if size == 0 {
        return 1.0;
    }
    let columns = matrix.chunks_exact(size).zip(weights);
    let most = columns.map(|(column, w)| column.iter().map(|v| v.abs()).sum::<f64>() / w).fold(0.0, f64::max);
    let columns = inverse.chunks_exact(size);
    let sums = columns.map(|column| column.iter().zip(weights).map(|(v, w)| (v * w).abs()).sum::<f64>());
    most * sums.fold(0.0, f64::max)
}

/// `out` = `scale` * `a` `x` for a column-major square matrix.
pub(crate) fn multiply(a: &[f64], x: &[f64], scale: f64, out: &mut [f64]) {
    out.fill(0.0);
    for (column, &xj) in a.chunks_exact(x.len().max(1)).zip(x) {
        for (o, v) in out.iter_mut().zip(column) {
            *o += scale * xj * v;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverts_any_size() {
        for n in [1, 2, 3, 4, 7, 24, 25, 26, 40] {
            let a: Vec<f64> = (0..n * n)
                .map(|k| if k % (n + 1) == 0 { 3.0 + k as f64 } else { ((7 * k) % 11) as f64 / 11.0 })
                .collect();
            let mut inverse = vec![0.0; n * n];
            assert!(invert(n, &a, &mut inverse));
            let x: Vec<f64> = (0..n).map(|i| i as f64 - 1.5).collect();
            let (mut ax, mut back) = (vec![0.0; n], vec![0.0; n]);
            multiply(&a, &x, 1.0, &mut ax);
            multiply(&inverse, &ax, 1.0, &mut back);
            assert!(x.iter().zip(&back).all(|(u, v)| (u - v).abs() < 1e-12), "{n}");
        }
        assert!(invert(0, &[], &mut []));
        assert!(!invert(2, &[1.0, 2.0, 2.0, 4.0], &mut [0.0; 4]));
        assert!(!invert(2, &[1.0, f64::NAN, 2.0, 4.0], &mut [0.0; 4]));
        // no pivot where it would be without a swap
        let mut swapped = [0.0; 9];
        assert!(invert(3, &[0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 4.0, 0.0], &mut swapped));
        assert_eq!(swapped, [0.0, 1.0, 0.0, 0.0, 0.0, 0.25, 0.5, 0.0, 0.0]);
    }
}
