//! Legendre series of pose and reactions over a stretch of a scan.

use crate::numeric::legendre;
use crate::point::Clamp;
use crate::scan::{Noise, Track};
use crate::systematic::Correction;
use nalgebra::{DMatrix, Vector3};
use std::ops::Range;

/// Most terms of a series: the nine scans of the paper need 11 to 21 for all digits. More terms cost time as their third power.
const MOST_TERMS: usize = 24;
/// Fewest terms of the reactions' series.
const FEWEST_TERMS: usize = 4;
/// A term of the series is kept where it exceeds this many of its standard deviations in a channel.
const SIGNIFICANT: f64 = 3.0;
/// After this many insignificant terms the series ends.
const QUIET: usize = 3;
/// Terms added to the last significant one. The conditions determine them where the noise of the reactions hides them.
const SPARE: usize = 2;
/// Smallest standard deviation of the reactions, dimensionless: truncation of the series and rounding. Smaller: the least squares
/// become ill-conditioned on noise-free scans.
const EXACT: f64 = 1e-10;
/// Standard deviation of the reactions about their series, dimensionless, up to which it is rounding. Larger: a kink within a stretch passes.
const ROUNDED: f64 = 1e-8;

/// The part of the path that a stretch covers, mapped to t from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// Path parameter at t = 0, and half the path length.
    pub centre: f64,
    pub half: f64,
}

impl Interval {
    /// The t of a path parameter.
    pub fn local(&self, tau: f64) -> f64 {
        (tau - self.centre) / self.half
    }

    /// The first `terms` Legendre polynomials at t and their derivatives by the path parameter.
    pub fn basis(&self, t: f64, terms: usize) -> (Vec<f64>, Vec<f64>) {
        let (p, mut d) = legendre::with_derivatives(t, terms);
        d.iter_mut().for_each(|d| *d /= self.half);
        (p, d)
    }
}

/// Poses and reactions along a stretch without transitions.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub interval: Interval,
    /// Coefficients of x0, y0, phi0 and of f0x, f0y, m0z.
    pub pose: DMatrix<f64>,
    pub reactions: DMatrix<f64>,
    /// Normal matrix of the polynomials at the samples, and its inverse. The covariance of the coefficients of a reaction is its
    /// `variance` times the inverse.
    pub normal: DMatrix<f64>,
    pub inverse: DMatrix<f64>,
    pub variance: Vector3<f64>,
    /// Natural curvature of the rod.
    pub natural: f64,
    /// Tangent of the angle of friction, as that of a [`Clamp`].
    pub friction: f64,
    /// Whether it has as many terms as it may, by its samples or at all: the reactions may need more.
    pub truncated: bool,
}

impl Series {
    /// The shortest series through the samples of `range` whose residuals are noise; none for too few samples.
    pub fn through(track: &Track, range: Range<usize>, noise: &Noise) -> Option<Self> {
        let tau = track.tau.get(range.clone())?;
        let (&first, &last) = (tau.first()?, tau.last()?);
        let interval = Interval { centre: 0.5 * (first + last), half: 0.5 * (last - first) };
        let most = MOST_TERMS.min(tau.len() / 3);
        if most < FEWEST_TERMS || interval.half <= 0.0 {
            return None;
        }
        let clamps = &track.clamps[range];
        let reference = six(&clamps[clamps.len() / 2]);
        let mut normal = DMatrix::<f64>::zeros(most, most);
        let mut sums = DMatrix::<f64>::zeros(most, 6);
        for (&tau, clamp) in tau.iter().zip(clamps) {
            let p = polynomials(interval.local(tau), most);
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
        // coefficients in an orthonormal basis: each has the (long-run) variance of a sample
        let single = lower.solve_lower_triangular(&sums)?;
        let sigma = noise.variance.component_mul(&noise.long_run).map(f64::sqrt);
        let present = |j: &usize| (0..3).any(|c| single[(*j, c + 3)].abs() > SIGNIFICANT * sigma[c]);
        let mut terms = FEWEST_TERMS;
        while let Some(next) = (terms..most.min(terms + QUIET)).find(present) {
            terms = next + 1;
        }
        let terms = (terms + SPARE).min(most);
        let normal = normal.view((0, 0), (terms, terms)).into_owned();
        let lower = lower.view((0, 0), (terms, terms)).into_owned();
        let mut coefficients = lower.tr_solve_lower_triangular(&single.rows(0, terms).into_owned())?;
        let mut left = Vector3::zeros();
        for (&tau, clamp) in tau.iter().zip(clamps) {
            let p = polynomials(interval.local(tau), terms);
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
        let (pose, reactions) = (part(0), part(3));
        let Track { natural, friction, .. } = *track;
        let truncated = terms == most;
        Some(Self { interval, pose, reactions, normal, inverse, variance, natural, friction, truncated })
    }

    /// The first terms alone. They are nearly the best series of that length, because Legendre polynomials are nearly orthogonal.
    pub fn shortened(&self, terms: usize) -> Self {
        let terms = terms.min(self.terms());
        let block = |m: &DMatrix<f64>| m.view((0, 0), (terms, terms)).into_owned();
        Self {
            interval: self.interval,
            pose: self.pose.rows(0, terms).into_owned(),
            reactions: self.reactions.rows(0, terms).into_owned(),
            normal: block(&self.normal),
            inverse: block(&self.inverse),
            variance: self.variance,
            natural: self.natural,
            friction: self.friction,
            truncated: self.truncated,
        }
    }

    /// The series through displaced samples: that of the displacement, which is smooth, is added.
    pub fn displaced(&self, by: &Correction) -> Self {
        let terms = self.terms();
        let nodes = 2 * terms;
        let mut rows = DMatrix::zeros(terms, nodes);
        let mut moved = DMatrix::zeros(nodes, 6);
        let (mut natural, mut friction) = (self.natural, self.friction);
        for k in 0..nodes {
            let t = -(std::f64::consts::PI * (k as f64 + 0.5) / nodes as f64).cos();
            let [clamp, rate] = self.clamps(t);
            let there = by.apply(self.interval.centre + self.interval.half * t, &clamp, &rate).0;
            (natural, friction) = (there.natural, there.friction);
            let (from, to) = (six(&clamp), six(&there));
            (0..6).for_each(|c| moved[(k, c)] = to[c] - from[c]);
            legendre::values(t, rows.column_mut(k).as_mut_slice());
        }
        let (normal, right) = (&rows * rows.transpose(), rows * moved);
        let moved = normal.cholesky().map_or_else(|| DMatrix::zeros(terms, 6), |normal| normal.solve(&right));
        Self {
            pose: &self.pose + moved.columns(0, 3),
            reactions: &self.reactions + moved.columns(3, 3),
            natural,
            friction,
            ..self.clone()
        }
    }

    /// Whether the reactions leave it by rounding only.
    pub fn is_exact(&self) -> bool {
        !self.truncated && self.variance.max() < ROUNDED * ROUNDED
    }

    pub fn terms(&self) -> usize {
        self.normal.nrows()
    }

    /// The clamp and its rates at t.
    pub fn clamps(&self, t: f64) -> [Clamp; 2] {
        let (p, d) = self.interval.basis(t, self.terms());
        let by = |b: Vec<f64>, m: &DMatrix<f64>| {
            Vector3::from_fn(|c, _| m.column(c).iter().zip(&b).map(|(m, b)| m * b).sum())
        };
        [(p, self.natural, self.friction), (d, 0.0, 0.0)].map(|(b, natural, friction)| Clamp {
            pose: by(b.clone(), &self.pose),
            reactions: by(b, &self.reactions),
            natural,
            friction,
        })
    }
}

fn six(clamp: &Clamp) -> [f64; 6] {
    let (p, r) = (&clamp.pose, &clamp.reactions);
    [p.x, p.y, p.z, r.x, r.y, r.z]
}

/// The first `terms` Legendre polynomials at t.
fn polynomials(t: f64, terms: usize) -> [f64; MOST_TERMS] {
    let mut p = [0.0; MOST_TERMS];
    legendre::values(t, &mut p[..terms]);
    p
}
