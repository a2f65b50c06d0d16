//! Quantiles of the chi-squared distribution.

use std::f64::consts::PI;

/// The x that chi-squared of 3 degrees of freedom exceeds with probability `p`, never too small: from the bound
/// P(x) <= sqrt(2 x / pi) exp(-x / 2) (1 + 1 / x), whose relative error falls as x^-2.
pub(crate) fn exceeded_by_three(p: f64) -> f64 {
    falling_to(p, |x| (2.0 * x / PI).sqrt() * (-0.5 * x).exp() * (1.0 + 1.0 / x))
}

/// The x that chi-squared of 6 degrees of freedom exceeds with probability `p`: P(x) = exp(-x / 2) (1 + x / 2 + x^2 / 8).
pub(crate) fn exceeded_by_six(p: f64) -> f64 {
    falling_to(p, |x| (-0.5 * x).exp() * (1.0 + 0.5 * x + 0.125 * x * x))
}

/// The quantile of chi-squared at which a standard normal variable has its quantile `z`, by the cube-root approximation of
/// Wilson and Hilferty (1931): within 2 % at z = 1.6449 (95 %) from 2 degrees of freedom on. z = 0 gives the median.
pub(crate) fn wilson_hilferty(freedom: usize, z: f64) -> f64 {
    let freedom = freedom.max(1) as f64;
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + z * spread.sqrt()).powi(3)
}

/// The x from 4 on at which a falling function has fallen to `p`, by bisection.
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
            (exceeded_by_three(1e-3), 16.266),
            (exceeded_by_three(1e-6), 30.665),
            (exceeded_by_six(1e-3), 22.458),
            (exceeded_by_six(1e-6), 38.258),
            (wilson_hilferty(3, 1.6449), 7.815),
            (wilson_hilferty(11, 1.6449), 19.675),
            (wilson_hilferty(19, 1.6449), 30.144),
        ] {
            assert!((found / known - 1.0).abs() < 0.01, "{found} {known}");
        }
    }
}
