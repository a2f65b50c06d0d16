//! Legendre series over a stretch of a scan: what is smooth in there, in few numbers.

use crate::point::clamp::Clamp;
use crate::scan::local_cubic::Noise;
use crate::scan::track::Track;
use nalgebra::{DMatrix, Vector3};
use std::ops::Range;

/// Terms of the longest series: the nine scans of the paper need 11 to 21 for all digits.
const MOST: usize = 24;
/// Fewest terms of the reactions' series.
const LEAST: usize = 4;
/// A term of the series is there where it exceeds this many standard deviations.
const SIGNIFICANT: f64 = 3.0;
/// After so many terms that do not, none follows.
const QUIET: usize = 3;
/// Terms beyond the last one that is there: conditions are met with them that were not met without.
const SPARE: usize = 2;
/// Standard deviation, dimensionless, below which reactions are called exact: rounding and truncation of the series.
const EXACT: f64 = 1e-10;

/// Where a stretch lies along the scan, as t from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub centre: f64,
    pub half: f64,
}

impl Span {
    pub fn local(&self, tau: f64) -> f64 {
        (tau - self.centre) / self.half
    }

    /// The first `terms` Legendre polynomials and their derivatives by tau.
    pub fn basis(&self, t: f64, terms: usize) -> (Vec<f64>, Vec<f64>) {
        let (mut p, mut d) = (vec![1.0; terms], vec![0.0; terms]);
        if terms > 1 {
            (p[1], d[1]) = (t, 1.0);
        }
        for j in 2..terms {
            let n = j as f64;
            p[j] = ((2.0 * n - 1.0) * t * p[j - 1] - (n - 1.0) * p[j - 2]) / n;
            d[j] = d[j - 2] + (2.0 * n - 1.0) * p[j - 1];
        }
        d.iter_mut().for_each(|d| *d /= self.half);
        (p, d)
    }
}

/// Poses and reactions along a stretch without transitions.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub span: Span,
    /// Coefficients of x0, y0, phi0 and of f0x, f0y, m0z.
    pub pose: DMatrix<f64>,
    pub reactions: DMatrix<f64>,
    /// Normal matrix of the basis, and its inverse: the covariance of a reaction's coefficients is `variance` times it.
    pub normal: DMatrix<f64>,
    pub inverse: DMatrix<f64>,
    pub variance: Vector3<f64>,
}

impl Series {
    /// The shortest series through the samples of `range` that leaves nothing but noise.
    pub fn through(track: &Track, range: Range<usize>, noise: &Noise) -> Option<Self> {
        let tau = track.tau.get(range.clone())?;
        let (&first, &last) = (tau.first()?, tau.last()?);
        let span = Span { centre: 0.5 * (first + last), half: 0.5 * (last - first) };
        let most = MOST.min(tau.len() / 3);
        if most < LEAST || span.half <= 0.0 {
            return None;
        }
        let clamps = &track.clamps[range];
        let reference = six(&clamps[clamps.len() / 2]);
        let mut normal = DMatrix::<f64>::zeros(most, most);
        let mut sums = DMatrix::<f64>::zeros(most, 6);
        for (&tau, clamp) in tau.iter().zip(clamps) {
            let p = legendre(span.local(tau), most);
            let six = six(clamp);
            for i in 0..most {
                for j in 0..=i {
                    normal[(i, j)] += p[i] * p[j];
                }
                for c in 0..6 {
                    sums[(i, c)] += p[i] * (six[c] - reference[c]);
                }
            }
        }
        normal.fill_upper_triangle_with_lower_triangle();
        let lower = normal.clone().cholesky()?.l();
        // coefficients in an orthonormal basis: each has the variance of a sample, long runs considered
        let single = lower.solve_lower_triangular(&sums)?;
        let sigma = noise.variance.component_mul(&noise.long_run).map(f64::sqrt);
        let present = |j: &usize| (0..3).any(|c| single[(*j, c + 3)].abs() > SIGNIFICANT * sigma[c]);
        let mut terms = LEAST;
        while let Some(next) = (terms..most.min(terms + QUIET)).find(present) {
            terms = next + 1;
        }
        let terms = (terms + SPARE).min(most);
        let normal = normal.view((0, 0), (terms, terms)).into_owned();
        let lower = lower.view((0, 0), (terms, terms)).into_owned();
        let mut coefficients = lower.tr_solve_lower_triangular(&single.rows(0, terms).into_owned())?;
        let mut left = Vector3::zeros();
        for (&tau, clamp) in tau.iter().zip(clamps) {
            let p = legendre(span.local(tau), terms);
            let six = six(clamp);
            for c in 0..3 {
                let fitted: f64 = (0..terms).map(|j| p[j] * coefficients[(j, c + 3)]).sum();
                left[c] += (six[c + 3] - reference[c + 3] - fitted).powi(2);
            }
        }
        let found = left / (tau.len() - terms) as f64;
        for c in 0..6 {
            coefficients[(0, c)] += reference[c];
        }
        let variance = noise.variance.sup(&found).component_mul(&noise.long_run).map(|v| v.max(EXACT * EXACT));
        let inverse = normal.clone().cholesky()?.inverse();
        let part = |from| coefficients.columns(from, 3).into_owned();
        Some(Self { span, pose: part(0), reactions: part(3), normal, inverse, variance })
    }

    /// The first terms alone: nearly the best series of that length, as Legendre's polynomials are nearly orthogonal.
    pub fn shortened(&self, terms: usize) -> Self {
        let terms = terms.min(self.terms());
        let block = |m: &DMatrix<f64>| m.view((0, 0), (terms, terms)).into_owned();
        Self {
            span: self.span,
            pose: self.pose.rows(0, terms).into_owned(),
            reactions: self.reactions.rows(0, terms).into_owned(),
            normal: block(&self.normal),
            inverse: block(&self.inverse),
            variance: self.variance,
        }
    }

    pub fn terms(&self) -> usize {
        self.normal.nrows()
    }

    /// The clamp and its rates where the reactions have these coefficients.
    pub fn clamps(&self, t: f64) -> [Clamp; 2] {
        let (p, d) = self.span.basis(t, self.terms());
        let by = |b: Vec<f64>, m: &DMatrix<f64>| {
            Vector3::from_fn(|c, _| m.column(c).iter().zip(&b).map(|(m, b)| m * b).sum())
        };
        [p, d].map(|b| Clamp { pose: by(b.clone(), &self.pose), reactions: by(b, &self.reactions) })
    }
}

fn six(clamp: &Clamp) -> [f64; 6] {
    let (p, r) = (&clamp.pose, &clamp.reactions);
    [p.x, p.y, p.z, r.x, r.y, r.z]
}

fn legendre(t: f64, terms: usize) -> [f64; MOST] {
    let mut p = [1.0; MOST];
    p[1] = t;
    for j in 2..terms {
        let n = j as f64;
        p[j] = ((2.0 * n - 1.0) * t * p[j - 1] - (n - 1.0) * p[j - 2]) / n;
    }
    p
}
