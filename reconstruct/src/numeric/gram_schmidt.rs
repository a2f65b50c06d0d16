//! Orthonormal columns by the Gram-Schmidt method.

/// Scalar product.
// Inlined, so that the windows of the search for kinks, which have a fixed length, get code for that length.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four sums at once use the lanes of the processor; one sum would have to be added in order.
    let mut sums = [0.0; 4];
    let ((fours_a, rest_a), (fours_b, rest_b)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    for (a, b) in fours_a.iter().zip(fours_b) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Subtracts `share` times `b` from `a`.
#[inline(always)]
pub(crate) fn subtract(a: &mut [f64], share: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= share * b);
}

/// Makes `column` orthogonal to the orthonormal `others` and of length 1; returns its length before it was scaled.
///
/// Each projection is taken off twice, which leaves no more than rounding (Giraud, Langou and Rozloznik 2005).
pub(crate) fn orthonormalise<C: AsRef<[f64]>>(column: &mut [f64], others: &[C]) -> f64 {
    for _ in 0..2 {
        for other in others {
            let share = dot(column, other.as_ref());
            subtract(column, share, other.as_ref());
        }
    }
    let norm = dot(column, column).sqrt();
    if norm > 0.0 {
        column.iter_mut().for_each(|c| *c /= norm);
    }
    norm
}
