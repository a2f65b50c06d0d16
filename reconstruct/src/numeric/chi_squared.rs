//! Quantiles of the chi-squared distribution, as far as thresholds need them.

use std::f64::consts::PI;

/// The x that chi-squared of 3 degrees of freedom exceeds with probability `p`, never too small: from the bound
/// P(x) <= sqrt(2 x / pi) exp(-x / 2) (1 + 1 / x), exact but for x^-2 in the tail.
pub(crate) fn three(p: f64) -> f64 {
    falling_to(p, |x| (2.0 * x / PI).sqrt() * (-0.5 * x).exp() * (1.0 + 1.0 / x))
}

/// The same of 6 degrees of freedom: P(x) = exp(-x / 2) (1 + x / 2 + x^2 / 8).
pub(crate) fn six(p: f64) -> f64 {
    falling_to(p, |x| (-0.5 * x).exp() * (1.0 + 0.5 * x + 0.125 * x * x))
}

/// The 95 % quantile for `freedom` degrees of freedom (Wilson and Hilferty 1931), within 2 % from 2 degrees on.
pub(crate) fn usual(freedom: usize) -> f64 {
    let freedom = freedom.max(1) as f64;
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + 1.6449 * spread.sqrt()).powi(3)
}

/// Where a function that falls from x = 4 on has fallen to `p`, by bisection.
fn falling_to(p: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (4.0, 2000.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) > p { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        // R: qchisq(c(1e-3, 1e-6), 3, lower = FALSE), the same of 6, and qchisq(0.95, c(3, 11, 19))
        for (found, known) in [
            (three(1e-3), 16.266),
            (three(1e-6), 30.665),
            (six(1e-3), 22.458),
            (six(1e-6), 38.258),
            (usual(3), 7.815),
            (usual(11), 19.675),
            (usual(19), 30.144),
        ] {
            assert!((found / known - 1.0).abs() < 0.01, "{found} {known}");
        }
    }
}
