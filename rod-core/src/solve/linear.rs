//! Inverse of a small dense matrix, on the stack up to the dimension of three contacts that stick.

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
    // 3 n of a boundary-value problem, one more for each contact that sticks, and one more of its continuation along a path, n <= 3; links
    // in a row need no more than 4
    of_known_size!(closed: 1 2 3 4; columns: 5 6 7 8 9 10 11 12 13) && inverse.iter().all(|v| v.is_finite())
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

/// Condition number of the column-major square matrix `a` in the 1-norm, with each unknown in units of 1 / `weight`; 1 of an empty one.
#[inline(always)]
pub(crate) fn condition(dimension: usize, a: &[f64], inverse: &[f64], weight: impl Fn(usize) -> f64) -> f64 {
    if dimension == 0 {
        return 1.0;
    }
    let (mut most, mut most_of_inverse) = (0.0_f64, 0.0_f64);
    for (k, (column, solution)) in a.chunks_exact(dimension).zip(inverse.chunks_exact(dimension)).enumerate() {
        most = most.max(column.iter().map(|v| v.abs()).sum::<f64>() / weight(k));
        most_of_inverse = most_of_inverse.max(solution.iter().enumerate().map(|(i, v)| (v * weight(i)).abs()).sum());
    }
    most * most_of_inverse
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
