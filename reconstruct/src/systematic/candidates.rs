//! Which source of error explains a scan, if only one is wrong.

use super::calibration::Calibration;
use super::source::Source;
use nalgebra::{DMatrix, DVector};

/// Smallest variance of a combination of estimates, in those of what was known before. Smaller: rounding.
const FINEST: f64 = 1e-12;

/// What explains a scan, besides bias and drift, which every scan has of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SourceCandidate {
    /// Bias and drift alone.
    Tare,
    /// One more source: the estimate where all others are as known, in the unit of the source.
    One(Source, f64),
    /// All sources together.
    Several,
}

/// The candidates, each with the logarithm of its likelihood but for a constant: the most likely one need not be first.
///
/// To second order about the estimate, the misfit of errors e is that of a normal density with the information D that the places alone
/// tell. The likelihood of a set of sources S is the integral of this density times that of what is known before over the errors of S, the
/// others being as known (Laplace's method): r^T N^-1 r / 2 - ln det(N G^-1) / 2, where G holds the inverse variances given for S, N = D +
/// G, and r = D times the errors that the places alone ask for, all restricted to S.
pub(crate) fn candidates(calibration: &Calibration) -> Vec<(SourceCandidate, f64)> {
    let sources = &calibration.sources;
    let free: Vec<usize> = (0..sources.len()).filter(|k| sources[*k].given > 0.0).collect();
    if calibration.covariance.nrows() != sources.len() || free.is_empty() {
        return Vec::new();
    }
    let count = free.len();
    // in units of what is known before
    let given = |i: usize| sources[free[i]].given;
    let covariance =
        DMatrix::from_fn(count, count, |i, j| calibration.covariance[(free[i], free[j])] / (given(i) * given(j)));
    let eigen = covariance.symmetric_eigen();
    let inverse = DMatrix::from_diagonal(&eigen.eigenvalues.map(|value| 1.0 / value.max(FINEST)));
    let whole = &eigen.eigenvectors * inverse * eigen.eigenvectors.transpose();
    let off = DVector::from_fn(count, |i, _| (sources[free[i]].value - sources[free[i]].known) / given(i));
    let right = &whole * off;
    // a budget that was raised tells less before: what the places tell stays
    let normal = DMatrix::from_fn(count, count, |i, j| {
        let prior = (given(i) / sources[free[i]].budget).powi(2);
        whole[(i, j)] + if i == j { 1.0 - prior } else { 0.0 }
    });
    let likelihood = |set: &[usize]| {
        let part = DMatrix::from_fn(set.len(), set.len(), |i, j| normal[(set[i], set[j])]);
        let right = DVector::from_fn(set.len(), |i, _| right[set[i]]);
        let root = part.cholesky()?;
        let best = root.solve(&right);
        let log = 0.5 * right.dot(&best) - root.l().diagonal().map(f64::ln).sum();
        log.is_finite().then_some((best, log))
    };
    let tare: Vec<usize> = (0..count).filter(|i| sources[free[*i]].source.is_of_scan()).collect();
    let others = (0..count).filter(|i| !sources[free[*i]].source.is_of_scan());
    let mut found: Vec<(SourceCandidate, f64)> = others
        .filter_map(|i| {
            let (best, log) = likelihood(&[&tare[..], &[i]].concat())?;
            let estimate = &sources[free[i]];
            let value = estimate.known + best[tare.len()] * given(i);
            Some((SourceCandidate::One(estimate.source, value), log))
        })
        .collect();
    found.extend(likelihood(&tare).map(|(_, log)| (SourceCandidate::Tare, log)));
    found.extend(likelihood(&(0..count).collect::<Vec<_>>()).map(|(_, log)| (SourceCandidate::Several, log)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systematic::SourceEstimate;

    /// A scan that measures the sum of stiffness and gain, and the bias.
    fn scan(sum: f64, sigma: f64, budgets: [f64; 2]) -> Calibration {
        let known = |source, given: f64| SourceEstimate {
            source,
            known: 0.0,
            given,
            budget: given,
            value: 0.0,
            sigma: 0.0,
            taken: 0.0,
            raised: false,
        };
        let mut sources =
            vec![known(Source::BiasF0x, 1.0), known(Source::GainF0x, budgets[0]), known(Source::Stiffness, budgets[1])];
        let sums = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 1.0]) / sigma;
        let measured = DVector::from_row_slice(&[0.3, sum]) / sigma;
        let prior = DMatrix::from_diagonal(&DVector::from_fn(3, |k, _| sources[k].given.powi(-2)));
        let covariance = (sums.transpose() * &sums + prior).try_inverse().unwrap();
        let value = &covariance * sums.transpose() * measured;
        sources.iter_mut().zip(value.iter()).for_each(|(source, value)| source.value = *value);
        Calibration {
            sources,
            covariance,
            ties: Vec::new(),
            free: Vec::new(),
            direction: 1.0,
            log_likelihood: 0.0,
            misfit_criterion: 0.0,
            misfit_length: 0.0,
            misfit_tangent: 0.0,
        }
    }

    #[test]
    fn the_likelihood_is_the_density_of_what_was_measured() {
        let (sum, sigma, budgets) = (0.04, 1e-3, [0.01, 0.05]);
        let found = candidates(&scan(sum, sigma, budgets));
        let of = |wanted: &dyn Fn(&SourceCandidate) -> bool| *found.iter().find(|one| wanted(&one.0)).unwrap();
        // the sum has the variance of the noise and of the sources that are free
        let density = |free: f64| {
            let variance: f64 = sigma * sigma + free;
            -0.5 * (sum * sum / variance + variance.ln())
        };
        let tare = of(&|one| *one == SourceCandidate::Tare).1;
        let gain = of(&|one| matches!(one, SourceCandidate::One(Source::GainF0x, _)));
        let stiffness = of(&|one| matches!(one, SourceCandidate::One(Source::Stiffness, _)));
        let several = of(&|one| *one == SourceCandidate::Several).1;
        let near = |found: f64, free: f64| {
            let expected = density(free) - density(0.0);
            assert!((found - tare - expected).abs() < 1e-6 * expected.abs(), "{} {expected}", found - tare);
        };
        near(gain.1, 1e-4);
        near(stiffness.1, 25e-4);
        near(several, 26e-4);
        let SourceCandidate::One(_, value) = stiffness.0 else { unreachable!() };
        assert!((value - 0.04 * 25e-4 / (25e-4 + 1e-6)).abs() < 1e-9, "{value}");
    }
}
