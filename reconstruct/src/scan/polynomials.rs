//! Orthonormal polynomials at the places of the samples of a window.

use crate::numeric::orthonormalise;

/// Polynomials of degree 0 to N - 1 over windows of one length, computed anew only where the spacing changes.
pub(super) struct Bases<const N: usize> {
    columns: [Vec<f64>; N],
    /// Length of the window of `columns` if its places are evenly spaced.
    span: f64,
}

impl<const N: usize> Bases<N> {
    /// For windows of `length` (at least 2) samples.
    pub fn new(length: usize) -> Self {
        Self { columns: std::array::from_fn(|_| vec![0.0; length]), span: f64::NAN }
    }

    /// The polynomials at the places `t`, which increase.
    pub fn at(&mut self, t: &[f64]) -> &[Vec<f64>; N] {
        let span = t[t.len() - 1] - t[0];
        let evenly = even_enough(t, span);
        let same = evenly && (span - self.span).abs() < 1e-6 * span;
        if !same {
            self.span = if evenly { span } else { f64::NAN };
            orthonormal(t, &mut self.columns);
        }
        &self.columns
    }
}

/// Fills the columns with orthonormal polynomials at the places `t`.
fn orthonormal<const N: usize>(t: &[f64], basis: &mut [Vec<f64>; N]) {
    let (first, last) = (t[0], t[t.len() - 1]);
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
    for (i, t) in t.iter().enumerate() {
        let u = (t - middle) / half;
        let mut power = 1.0;
        for column in basis.iter_mut() {
            column[i] = power;
            power *= u;
        }
    }
    for k in 0..N {
        let (before, rest) = basis.split_at_mut(k);
        orthonormalise(&mut rest[0], before);
    }
}

/// Whether places are evenly spaced but for rounding, so that one basis serves for many windows.
fn even_enough(t: &[f64], span: f64) -> bool {
    let step = span / (t.len() - 1) as f64;
    t.iter().enumerate().all(|(i, x)| (x - t[0] - step * i as f64).abs() < 1e-6 * step)
}
