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

/// The probability that chi-squared of so many degrees of freedom (not necessarily a whole number, 1 at least) is `x` or more, by the
/// cube-root approximation of Wilson and Hilferty (1931): within 10 % of itself down to 1e-5 from 30 degrees of freedom on.
pub(crate) fn upper_tail(x: f64, freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    beyond((((x / freedom).max(0.0)).cbrt() - (1.0 - spread)) / spread.sqrt())
}

/// The probability that a standard normal variable is `z` or more, relative error below 1e-8: by its Taylor series, and from 2 on by the
/// continued fraction of Laplace.
pub(crate) fn beyond(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / (2.0 * PI).sqrt();
    if z > 2.0 {
        let fraction = (1..=60).rev().fold(z, |rest, k| z + f64::from(k) / rest);
        return density / fraction;
    }
    if z < -2.0 {
        return 1.0 - beyond(-z);
    }
    let (mut term, mut sum) = (z, z);
    for k in 1..60 {
        term *= z * z / f64::from(2 * k + 1);
        sum += term;
    }
    0.5 - density * sum
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
    fn tails_are_those_of_tables() {
        // R: pnorm(z, lower = FALSE), pchisq(x, k, lower = FALSE)
        for (z, p) in
            [(-3.0, 0.998_650_101_968_37), (0.0, 0.5), (1.6449, 0.049_995_2), (2.5, 6.209_665e-3), (6.0, 9.865_876e-10)]
        {
            assert!((beyond(z) / p - 1.0).abs() < 1e-6, "{z} {} {p}", beyond(z));
        }
        for (x, freedom, p) in [(50.0, 36.0, 0.060_475), (80.0, 36.0, 3.470e-5), (1800.0, 1700.0, 0.045_147)] {
            assert!((upper_tail(x, freedom) / p - 1.0).abs() < 0.1, "{x} {freedom} {}", upper_tail(x, freedom));
        }
    }

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
