//! One stretch of a run, described by the coefficients of series.

use super::series::Series;
use super::unknowns::{Gradient, Unknown, Unknowns};
use nalgebra::{DMatrix, DVector, Matrix6, Vector3};

/// Instants of a stretch at which covariances are computed; they are interpolated linearly in between.
pub(super) const INSTANTS: usize = 33;

/// The t of an instant.
pub(super) fn place(k: usize) -> f64 {
    -1.0 + 2.0 * k as f64 / (INSTANTS - 1) as f64
}

/// One stretch of a run, and the place of its unknowns in the vector of all: the coefficients of f0x, f0y, m0z (as many terms as
/// the series has), of s1, f1 and, where the second contact is not at the tip, s2 (`terms` each).
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub series: Series,
    /// Whether the second contact is at the tip.
    pub tip: bool,
    pub terms: usize,
    /// Index of the first coefficient.
    pub start: usize,
}

/// Pose, unknowns and their rates at one place of a stretch, with the polynomials there.
pub(super) struct Local {
    pub pose: [Vector3<f64>; 2],
    /// Natural curvature of the rod.
    pub natural: f64,
    /// Tangent of the angle of friction.
    pub friction: f64,
    pub values: Unknowns,
    pub rates: Unknowns,
    pub basis: [Vec<f64>; 2],
}

impl Part {
    /// Number of coefficients.
    pub fn width(&self) -> usize {
        3 * self.series.terms() + if self.tip { 2 } else { 3 } * self.terms
    }

    /// Size of the mean force at the clamp.
    pub fn force_at_clamp(&self) -> f64 {
        let [f0x, f0y] = [Unknown::F0x, Unknown::F0y].map(|u| self.series.reactions[(0, u as usize)]);
        f0x.hypot(f0y)
    }

    /// Index of the first coefficient of an unknown, and the number of its coefficients.
    pub fn columns(&self, unknown: Unknown) -> (usize, usize) {
        let n = self.series.terms();
        match unknown {
            Unknown::F0x | Unknown::F0y | Unknown::M0z => (self.start + unknown as usize * n, n),
            Unknown::S2 if self.tip => (0, 0),
            Unknown::S1 | Unknown::F1 | Unknown::S2 => {
                (self.start + 3 * n + (unknown as usize - Unknown::S1 as usize) * self.terms, self.terms)
            }
        }
    }

    /// The unknowns at t, where the coefficients are x.
    pub fn local(&self, x: &DVector<f64>, t: f64) -> Local {
        let (p, d) = self.series.interval.basis(t, self.series.terms().max(self.terms));
        let dot = |b: &[f64], unknown: Unknown| {
            let (from, count) = self.columns(unknown);
            (0..count).map(|j| b[j] * x[from + j]).sum::<f64>()
        };
        let mut values = Unknowns::from_fn(|unknown| dot(&p, unknown));
        let rates = Unknowns::from_fn(|unknown| dot(&d, unknown));
        if self.tip {
            values[Unknown::S2] = 1.0;
        }
        let pose = [&p, &d].map(|b| {
            Vector3::from_fn(|c, _| self.series.pose.column(c).iter().zip(b).map(|(m, b)| m * b).sum::<f64>())
        });
        Local { pose, natural: self.series.natural, friction: self.series.friction, values, rates, basis: [p, d] }
    }

    /// Derivatives by the unknowns and their rates as derivatives by the coefficients, appended to a sparse row.
    pub fn spread(&self, local: &Local, by: &Gradient, row: &mut Vec<(usize, f64)>) {
        for unknown in Unknown::ALL {
            let (from, count) = self.columns(unknown);
            for j in 0..count {
                let rate = by.by_rate[unknown] * local.basis[1][j];
                row.push((from + j, by.by_value[unknown] * local.basis[0][j] + rate));
            }
        }
    }

    /// Variance of a number with this gradient by the noise of the reactions.
    pub fn noise(&self, local: &Local, by: &Gradient) -> f64 {
        let n = self.series.terms();
        let of_reaction = |u: Unknown| {
            let (value, rate) = (by.by_value[u], by.by_rate[u]);
            let q = DVector::from_fn(n, |j, _| value * local.basis[0][j] + rate * local.basis[1][j]);
            self.series.variance[u as usize] * q.dot(&(&self.series.inverse * &q))
        };
        Unknown::REACTIONS.into_iter().map(of_reaction).sum()
    }

    /// Instants at which the conditions are imposed: Chebyshev nodes, three more than the longest series has terms, so that every term
    /// is determined.
    pub fn instants(&self) -> impl Iterator<Item = f64> + use<> {
        let count = self.series.terms().max(self.terms) + 3;
        (0..count).map(move |k| -(std::f64::consts::PI * (k as f64 + 0.5) / count as f64).cos())
    }

    /// Standard deviation of the rate of the first arc length.
    pub fn sigma_of_rate(&self, local: &Local, covariance: &DMatrix<f64>) -> f64 {
        let (from, count) = self.columns(Unknown::S1);
        let rate = DVector::from_fn(count, |j, _| local.basis[1][j]);
        rate.dot(&(covariance.view((from, from), (count, count)) * &rate)).max(0.0).sqrt()
    }

    /// Covariance of the unknowns at a place, where that of the coefficients is given.
    pub fn covariance(&self, local: &Local, coefficients: &DMatrix<f64>) -> Matrix6<f64> {
        Matrix6::from_fn(|i, k| {
            let ((a, m), (b, n)) = (self.columns(Unknown::ALL[i]), self.columns(Unknown::ALL[k]));
            let mut sum = 0.0;
            for u in 0..m {
                for v in 0..n {
                    sum += local.basis[0][u] * coefficients[(a + u, b + v)] * local.basis[0][v];
                }
            }
            sum
        })
    }
}
