//! Legendre polynomials on [-1, 1].

/// P_4(t).
pub(crate) fn fourth(t: f64) -> f64 {
    let t2 = t * t;
    (4.375 * t2 - 3.75) * t2 + 0.375
}

/// P_5(t).
pub(crate) fn fifth(t: f64) -> f64 {
    let t2 = t * t;
    ((7.875 * t2 - 8.75) * t2 + 1.875) * t
}

/// Fills `values` with P_0(t), P_1(t), ..., by Bonnet's recursion.
pub(crate) fn values(t: f64, values: &mut [f64]) {
    let (mut before, mut last) = (0.0, 1.0);
    for (j, value) in values.iter_mut().enumerate() {
        if j > 0 {
            let n = j as f64;
            (before, last) = (last, ((2.0 * n - 1.0) * t * last - (n - 1.0) * before) / n);
        }
        *value = last;
    }
}

/// The first `terms` polynomials at `t`, and their derivatives by t.
pub(crate) fn with_derivatives(t: f64, terms: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut p, mut d) = (vec![0.0; terms], vec![0.0; terms]);
    values(t, &mut p);
    for j in 1..terms {
        let before = if j < 2 { 0.0 } else { d[j - 2] };
        d[j] = before + (2.0 * j as f64 - 1.0) * p[j - 1];
    }
    (p, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recursion_closed_forms_and_derivatives_agree() {
        for t in [-1.0, -0.3, 0.0, 0.7, 1.0] {
            let (p, d) = with_derivatives(t, 6);
            assert!((p[4] - fourth(t)).abs() < 1e-15 && (p[5] - fifth(t)).abs() < 1e-15);
            assert!((d[4] - (17.5 * t * t - 7.5) * t).abs() < 1e-14 && d[0] == 0.0 && d[1] == 1.0);
        }
        assert_eq!((with_derivatives(0.5, 1), with_derivatives(0.5, 0).0), ((vec![1.0], vec![0.0]), Vec::new()));
    }
}
