//! Local cubics through the reactions: values, rates and their covariance, from a part of a scan without transitions.

use super::noise::Noise;
use super::track::Track;
use crate::numeric::legendre;
use crate::point::Clamp;
use nalgebra::{Matrix4, SMatrix, Vector3, Vector4};
use std::ops::Range;

/// Samples on either side of a place that the narrowest window takes.
const NARROWEST: usize = 8;
/// Factor by which a window grows while the cubic still fits. Larger: fewer fits are tried, and the window is further from the
/// best one.
const GROWTH: f64 = 1.5;
/// Largest excess of the residual sum of squares over what the noise lets expect, in its standard deviations. Larger: wider
/// windows, which are less noisy and more biased. Many windows are tried, so that a smaller one rejects some by chance.
const MOST_EXCESS: f64 = 5.0;
/// Largest Legendre terms of degree 4 and 5 in the residuals, in their standard deviations. They show a bias long before the sum
/// of squares does.
const MOST_BIAS: f64 = 4.5;

/// A cubic through the samples of a window.
#[derive(Clone, Debug)]
pub(crate) struct LocalCubic {
    centre: f64,
    half: f64,
    /// Coefficients of x0, y0, phi0, f0x, f0y, m0z, in powers of (tau - centre) / half.
    coefficients: SMatrix<f64, 4, 6>,
    /// Inverse of the normal matrix.
    inverse: Matrix4<f64>,
    /// Variance of a reaction's coefficients is this times the inverse.
    variance: Vector3<f64>,
    /// Natural curvature of the rod.
    natural: f64,
    /// Tangent of the angle of friction.
    friction: f64,
    pub window: Range<usize>,
}

/// Clamp and rates at one place, with the covariance of the reactions and of their rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalEstimate {
    pub clamp: Clamp,
    pub rate: Clamp,
    /// Variance of a value, covariance of value and rate, variance of a rate are `variance` times these.
    shape: [f64; 3],
    variance: Vector3<f64>,
}

impl LocalEstimate {
    /// A place known without error.
    pub fn exact(clamp: Clamp, rate: Clamp) -> Self {
        Self { clamp, rate, shape: [0.0; 3], variance: Vector3::zeros() }
    }

    /// The same with another clamp and rates, and the same noise.
    pub fn moved(&self, clamp: Clamp, rate: Clamp) -> Self {
        Self { clamp, rate, ..*self }
    }

    /// Covariance of the reactions.
    pub fn covariance(&self) -> nalgebra::Matrix3<f64> {
        nalgebra::Matrix3::from_diagonal(&(self.variance * self.shape[0]))
    }

    /// Variance of a number with these derivatives by the reactions and by their rates.
    pub fn variance(&self, by_value: &Vector3<f64>, by_rate: &Vector3<f64>) -> f64 {
        self.mixed([by_value, by_rate], [by_value, by_rate]).max(0.0)
    }

    /// Covariance of two numbers with such derivatives.
    pub fn mixed(&self, u: [&Vector3<f64>; 2], v: [&Vector3<f64>; 2]) -> f64 {
        let [vv, vr, rr] = self.shape;
        (0..3)
            .map(|c| {
                self.variance[c]
                    * (vv * u[0][c] * v[0][c] + vr * (u[0][c] * v[1][c] + u[1][c] * v[0][c]) + rr * u[1][c] * v[1][c])
            })
            .sum()
    }
}

impl LocalCubic {
    /// The cubic through the samples of the window and whether it fits within the noise; none for too few samples.
    fn through(track: &Track, window: Range<usize>, noise: &Noise) -> Option<(Self, bool)> {
        let tau = &track.tau[window.clone()];
        let (first, last) = (*tau.first()?, *tau.last()?);
        let (centre, half) = (0.5 * (first + last), 0.5 * (last - first));
        if tau.len() < 5 || half <= 0.0 {
            return None;
        }
        let reference = Self::six(&track.clamps[window.start + tau.len() / 2]);
        let mut powers = [0.0; 7];
        let mut sums = SMatrix::<f64, 4, 6>::zeros();
        for (tau, clamp) in tau.iter().zip(&track.clamps[window.clone()]) {
            let t = (tau - centre) / half;
            let basis = Vector4::new(1.0, t, t * t, t * t * t);
            let t3 = basis[3];
            for (k, power) in powers.iter_mut().enumerate() {
                *power += if k < 4 { basis[k] } else { t3 * basis[k - 3] };
            }
            let values = Self::six(clamp) - reference;
            sums += basis * values.transpose();
        }
        let normal = Matrix4::from_fn(|i, j| powers[i + j]);
        let inverse = normal.cholesky()?.inverse();
        let mut coefficients = inverse * sums;
        let (mut residuals, mut fourth, mut fifth) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        for (tau, clamp) in tau.iter().zip(&track.clamps[window.clone()]) {
            let t = (tau - centre) / half;
            let basis = Vector4::new(1.0, t, t * t, t * t * t);
            let fitted = coefficients.fixed_columns::<3>(3).tr_mul(&basis);
            let off = clamp.reactions - reference.fixed_rows::<3>(3) - fitted;
            residuals += off.component_mul(&off);
            // Legendre polynomials are orthogonal to the cubic, as the residuals are
            fourth += off * legendre::fourth(t);
            fifth += off * legendre::fifth(t);
        }
        let freedom = tau.len() as f64 - 4.0;
        let found = residuals / freedom;
        let limit = |c: usize| noise.variance[c] * (1.0 + MOST_EXCESS * (2.0 * noise.long_run[c] / freedom).sqrt());
        let biased = |c: usize| {
            // the mean of P_n^2 over [-1, 1] is 1 / (2 n + 1)
            let scale = (noise.variance[c] * noise.long_run[c] * tau.len() as f64).sqrt();
            fourth[c].abs() > MOST_BIAS * scale / 9.0_f64.sqrt() || fifth[c].abs() > MOST_BIAS * scale / 11.0_f64.sqrt()
        };
        let fits = (0..3).all(|c| found[c] <= limit(c) && !biased(c));
        for (c, value) in reference.iter().enumerate() {
            coefficients[(0, c)] += value;
        }
        let variance = noise.variance.sup(&found).component_mul(&noise.long_run);
        let Track { natural, friction, .. } = *track;
        Some((Self { centre, half, coefficients, inverse, variance, natural, friction, window }, fits))
    }

    fn six(clamp: &Clamp) -> SMatrix<f64, 6, 1> {
        let (p, r) = (&clamp.pose, &clamp.reactions);
        SMatrix::<f64, 6, 1>::new(p.x, p.y, p.z, r.x, r.y, r.z)
    }

    /// The widest cubic about sample `index` that fits within the noise, from samples of `part` only, at most `most` on one side.
    pub fn about(track: &Track, index: usize, part: Range<usize>, noise: &Noise, most: usize) -> Option<Self> {
        let window = |half: usize| {
            let length = (2 * half + 1).min(part.len());
            let start = index.saturating_sub(half).clamp(part.start, part.end - length);
            start..start + length
        };
        let mut half = NARROWEST.min(most);
        let mut best = Self::through(track, window(half), noise)?.0;
        let mut narrower = None;
        while half < most && best.window.len() < part.len() {
            half = ((half as f64 * GROWTH).ceil() as usize).min(most);
            match Self::through(track, window(half), noise) {
                Some((wider, true)) => narrower = Some(std::mem::replace(&mut best, wider)),
                // The last one that passed may be biased by as much as its noise. The bias of a cubic grows with the fourth
                // to fifth power of the window: one step narrower it is a sixth.
                _ => return Some(narrower.unwrap_or(best)),
            }
        }
        Some(best)
    }

    /// Gives the contacts friction whose angle has this tangent.
    pub fn set_friction(&mut self, friction: f64) {
        self.friction = friction;
    }

    /// Values and rates at tau.
    pub fn at(&self, tau: f64) -> LocalEstimate {
        let t = (tau - self.centre) / self.half;
        let value = Vector4::new(1.0, t, t * t, t * t * t);
        let rate = Vector4::new(0.0, 1.0, 2.0 * t, 3.0 * t * t) / self.half;
        let split = |basis: &Vector4<f64>| {
            let six = self.coefficients.tr_mul(basis);
            Clamp {
                pose: six.fixed_rows::<3>(0).into_owned(),
                reactions: six.fixed_rows::<3>(3).into_owned(),
                natural: 0.0,
                friction: 0.0,
            }
        };
        let (at_value, at_rate) = (self.inverse * value, self.inverse * rate);
        LocalEstimate {
            clamp: Clamp { natural: self.natural, friction: self.friction, ..split(&value) },
            rate: split(&rate),
            shape: [value.dot(&at_value), value.dot(&at_rate), rate.dot(&at_rate)],
            variance: self.variance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_exactly_and_a_kink_keeps_the_window_small() {
        let tau: Vec<f64> = (0..200).map(|i| 1e-3 * f64::from(i)).collect();
        let clamp = |tau: f64, bend: f64| Clamp {
            pose: Vector3::new(tau, 2.0, 0.5),
            reactions: Vector3::new(1.0 + tau, tau.powi(3) + bend * (tau - 0.1).max(0.0), 3.0),
            natural: 0.0,
            friction: 0.0,
        };
        let noise = Noise { variance: Vector3::repeat(1e-24), long_run: Vector3::repeat(1.0) };
        for (bend, widest) in [(0.0, 200), (1.0, 50)] {
            let track =
                Track { clamps: tau.iter().map(|&t| clamp(t, bend)).collect(), tau: tau.clone(), ..Track::default() };
            let fit = LocalCubic::about(&track, 80, 0..200, &noise, 1000).unwrap();
            assert!(fit.window.len() <= widest && fit.window.len() >= widest / 2, "{:?}", fit.window);
            let at = fit.at(0.08);
            assert!((at.clamp.reactions.y - 0.08_f64.powi(3)).abs() < 1e-13);
            assert!((at.rate.reactions.y - 3.0 * 0.08_f64.powi(2)).abs() < 1e-11, "{}", at.rate.reactions.y);
            assert!((at.rate.pose.x - 1.0).abs() < 1e-12);
        }
    }
}
