//! Which shared errors a recording asks for, by evidence, from a fit with all of them free.

use super::problem::Sources;
use crate::systematic::Source;
use nalgebra::{DMatrix, DVector};

/// What a fit with some errors free tells of them, less what is known of them, in standard deviations of their budget; the contour follows them.
pub(super) struct Posterior {
    pub errors: DVector<f64>,
    pub covariance: DMatrix<f64>,
    /// How many errors might be free.
    pub possible: usize,
}

/// For each error whether it is free.
type Free = Vec<bool>;

/// The numbers of those that are free, or not.
pub(super) fn numbers(free: &[bool], are_free: bool) -> Vec<usize> {
    (0..free.len()).filter(|i| free[*i] == are_free).collect()
}

/// Logarithm of the number of ways to choose so many of `count`.
pub(super) fn log_choices(count: usize, chosen: usize) -> f64 {
    (0..chosen).map(|i| (((count - i) as f64) / ((i + 1) as f64)).ln()).sum()
}

impl Posterior {
    /// Logarithm of the determinant of the covariance of the errors that are not free, and by how much the cost rises without them; none where the
    /// covariance is singular.
    pub fn without(&self, free: &[bool]) -> Option<(f64, f64)> {
        let fixed = numbers(free, false);
        let root = self.covariance.select_rows(&fixed).select_columns(&fixed).cholesky()?;
        let errors = self.errors.select_rows(&fixed);
        Some((2.0 * root.l().diagonal().map(f64::ln).sum(), errors.dot(&root.solve(&errors))))
    }

    /// -2 times the logarithm of the probability that these errors are free, over that of all errors of the fit.
    ///
    /// The evidence by Laplace's method: with a budget of one, the integral over the errors that are fixed is the density of their posterior at 0. Every
    /// number of free errors is equally likely before, and so are all sets of a number (Scott and Berger 2010): one of many errors fits by chance.
    pub fn penalty(&self, free: &[bool]) -> f64 {
        let choices = |count: usize| log_choices(self.possible, count);
        let fewer = choices(numbers(free, true).len()) - choices(free.len());
        self.without(free).map_or(f64::INFINITY, |(freedom, rise)| rise + freedom + 2.0 * fewer)
    }

    /// The most probable set near one: none of the errors that may be fixed more or less, and no other one in place of one, is more probable.
    fn most_probable_near(&self, mut free: Free, may_be_fixed: &[usize]) -> (f64, Free) {
        let mut penalty = self.penalty(&free);
        loop {
            let flipped = |numbers: &[usize]| {
                let mut other = free.clone();
                numbers.iter().for_each(|i| other[*i] = !other[*i]);
                (self.penalty(&other), other)
            };
            let (ones, others): (Vec<usize>, Vec<usize>) = may_be_fixed.iter().partition(|i| free[**i]);
            let exchanges = ones.iter().flat_map(|i| others.iter().map(move |j| [*i, *j]));
            let exchanges = exchanges.map(|pair| flipped(&pair));
            let all = may_be_fixed.iter().map(|i| flipped(&[*i])).chain(exchanges);
            match all.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0 < penalty) {
                Some(best) => (penalty, free) = best,
                None => return (penalty, free),
            }
        }
    }

    /// The sets that are more probable than all errors of the fit, the most probable one first: near none, the biases, all errors of the scan, and all.
    /// What is always free is in each.
    pub fn sets(&self, sources: &Sources) -> Vec<Free> {
        let starts: [fn(Source) -> bool; 4] =
            [|_| false, |source| source <= Source::BiasM0z, Source::is_of_scan, |_| true];
        let is_kept = |i: &usize| sources.is_always_free(&sources.free[*i]);
        let may_be_fixed: Vec<usize> = (0..sources.free.len()).filter(|i| !is_kept(i)).collect();
        let near = |is_free: &fn(Source) -> bool| {
            let start = (0..sources.free.len()).map(|i| is_kept(&i) || is_free(sources.free[i].source)).collect();
            self.most_probable_near(start, &may_be_fixed)
        };
        let mut sets: Vec<(f64, Free)> = starts.iter().map(near).filter(|set| set.0 < 0.0).collect();
        sets.sort_by(|a, b| a.0.total_cmp(&b.0));
        sets.dedup_by(|a, b| a.1 == b.1);
        sets.into_iter().map(|set| set.1).collect()
    }

    /// Standard deviation of an error about a value, in those of its budget.
    pub fn spread_about(&self, i: usize, value: f64) -> f64 {
        self.covariance[(i, i)].max(0.0).sqrt().hypot(self.errors[i] - value)
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::FreeError;
    use super::*;

    /// Of three errors, of which a recording tells the first, and the sum of the others.
    fn posterior(measured: [f64; 2], sigma: f64) -> Posterior {
        let rows = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 1.0]) / sigma;
        let covariance = (rows.transpose() * &rows + DMatrix::identity(3, 3)).try_inverse().unwrap();
        let errors = &covariance * rows.transpose() * DVector::from_row_slice(&measured) / sigma;
        Posterior { errors, covariance, possible: 3 }
    }

    #[test]
    fn the_penalty_is_the_density_of_what_was_measured() {
        let (measured, sigma) = ([0.4, 0.3], 0.1);
        let posterior = posterior(measured, sigma);
        // -2 ln of the density, where so many errors of either measured value are free
        let density = |free: [f64; 2]| -> f64 {
            let of = |k: usize| {
                let variance: f64 = sigma * sigma + free[k];
                measured[k] * measured[k] / variance + variance.ln()
            };
            of(0) + of(1)
        };
        for (free, counts, choices) in [
            ([true, false, false], [1.0, 0.0], 3.0_f64),
            ([false; 3], [0.0, 0.0], 1.0),
            ([false, true, true], [0.0, 2.0], 3.0),
        ] {
            let expected = density(counts) - density([1.0, 2.0]) + 2.0 * choices.ln();
            let found = posterior.penalty(&free);
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn only_errors_that_are_needed_are_free() {
        let sources = Sources {
            free: [Source::BiasF0x, Source::GainF0x, Source::Stiffness]
                .map(|source| FreeError { source, recording: None })
                .into(),
            ..Sources::default()
        };
        let first = |measured| posterior(measured, 0.01).sets(&sources).into_iter().next();
        assert_eq!(first([0.5, 0.005]), Some(vec![true, false, false]));
        assert_eq!(first([0.005, 0.005]), Some(vec![false; 3]));
        // one of two that explain the same
        let one = first([0.005, 0.5]).unwrap();
        assert_eq!((one[0], numbers(&one, true).len()), (false, 1));
    }
}
