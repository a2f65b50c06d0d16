//! The two contacts of each sample, from the solution of a run.

use super::conditions::two;
use super::part::{Local, Part};
use super::run::Resolved;
use super::unknowns::{UNKNOWNS, Unknown, Unknowns};
use super::unresolved::Unresolved;
use crate::numeric::variance;
use crate::point::Touch;
use nalgebra::{DVector, Matrix6, SMatrix, SVector, Vector2};
use rod_core::Dual;

/// Instants of a stretch at which covariances are computed; they are interpolated linearly in between.
const INSTANTS: usize = 33;
/// The second force vanishes where it is within this many standard deviations of zero.
const VANISHES: f64 = 3.0;
/// Path length of a contact, rod lengths, below which it counts as standing still when its mean curvature is computed.
const STANDING: f64 = 1e-3;
/// Mean square of half the square of a normal variable, in units of its variance squared.
const FOURTH_MOMENT: f64 = 0.75;
const S1: usize = Unknown::S1 as usize;
const S2: usize = Unknown::S2 as usize;

/// Largest standard deviations of a contact, in rod lengths, and how well the ends of stretches are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Standard deviation of a contact across the contour.
    pub across: f64,
    /// Standard deviation of its arc length.
    pub along: f64,
    /// Samples at the ends of stretches that may belong to the neighbour.
    pub margin: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { across: 5e-3, along: 0.05, margin: 3 }
    }
}

/// The two contacts of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub first: Result<Touch, Unresolved>,
    pub second: Result<Touch, Unresolved>,
}

/// The contacts of the samples at these path parameters of a part, appended to `pairs`.
pub(super) fn answer(found: &Resolved, part: &Part, tau: &[f64], limits: &Limits, pairs: &mut Vec<Pair>) {
    let x = &found.solution.x;
    let place = |k: usize| -1.0 + 2.0 * k as f64 / (INSTANTS - 1) as f64;
    let covariances: Vec<Matrix6<f64>> = (0..INSTANTS)
        .map(|k| part.covariance(&part.local(x, place(k)), &found.solution.covariance) * found.excess)
        .collect();
    let bends = bends(part, x, place);
    for &tau in tau {
        let t = part.series.interval.local(tau);
        let u = (0.5 * (t.clamp(-1.0, 1.0) + 1.0)) * (INSTANTS - 1) as f64;
        let k = (u as usize).min(INSTANTS - 2);
        let w = u - k as f64;
        let covariance = covariances[k] * (1.0 - w) + covariances[k + 1] * w;
        let local = part.local(x, t);
        pairs.push(pair(part, &local, &covariance, bends, limits));
    }
}

/// The mean curvature of the contour along the paths of the two contacts, 1/L: by it an error along the contour becomes one across.
fn bends(part: &Part, x: &DVector<f64>, place: impl Fn(usize) -> f64) -> [f64; 2] {
    let (mut turned, mut passed) = ([0.0; 2], [0.0; 2]);
    let mut before: Option<[(f64, f64, f64); 2]> = None;
    for k in 0..INSTANTS {
        let local = part.local(x, place(k));
        let two = two(local.pose[0].into(), &local.values);
        let [a, b] = two.force;
        let turn = if part.tip { b.atan2(a) } else { two.second.phi };
        let here = [(two.first.x, two.first.y, two.first.phi), (two.second.x, two.second.y, turn)];
        if let Some(before) = before {
            for i in 0..2 {
                turned[i] += (here[i].2 - before[i].2).sin();
                passed[i] += (here[i].0 - before[i].0).hypot(here[i].1 - before[i].1);
            }
        }
        before = Some(here);
    }
    [0, 1].map(|i| turned[i] / passed[i].max(STANDING))
}

fn pair(part: &Part, local: &Local, covariance: &Matrix6<f64>, bends: [f64; 2], limits: &Limits) -> Pair {
    let values = Unknowns::from_fn(|unknown| Dual::variable(local.values[unknown], unknown as usize));
    let two = two(std::array::from_fn(|i| Dual::constant(local.pose[0][i])), &values);
    let bend = |s: &rod_core::Section<Dual<f64, UNKNOWNS>>| {
        let by =
            SMatrix::<f64, 2, UNKNOWNS>::from_fn(|r, c| if r == 0 { s.x.derivatives[c] } else { s.y.derivatives[c] });
        (s.x.value, s.y.value, by * covariance * by.transpose())
    };
    let f1 = local.values[Unknown::F1];
    let (x, y, spread1) = bend(&two.first);
    let phi = two.first.phi.value;
    let alpha = if f1 < 0.0 { phi + std::f64::consts::PI } else { phi };
    let alpha = alpha.sin().atan2(alpha.cos());
    let first = Touch {
        s: local.values[Unknown::S1],
        x,
        y,
        alpha,
        force: f1.abs(),
        covariance: spread1,
        systematic: nalgebra::Matrix2::zeros(),
    };
    let kappa = two.first.kappa.value;
    let first = judged(first, bends[0].abs() + kappa.abs(), covariance[(S1, S1)].max(0.0).sqrt(), limits);

    let [a, b] = two.force;
    let force = a.value.hypot(b.value);
    let by_force = SVector::<f64, UNKNOWNS>::from_fn(|i, _| {
        (a.value * a.derivatives[i] + b.value * b.derivatives[i]) / force.max(f64::MIN_POSITIVE)
    });
    let sigma_force = variance(&by_force, covariance).sqrt();
    let (x, y, spread2) = bend(&two.second);
    let second = Touch {
        s: local.values[Unknown::S2],
        x,
        y,
        alpha: b.value.atan2(a.value),
        force,
        covariance: spread2,
        systematic: nalgebra::Matrix2::zeros(),
    };
    let second = if force < VANISHES * sigma_force {
        Err(Unresolved::ForceVanishes)
    } else {
        let sigma_s = if part.tip { 0.0 } else { covariance[(S2, S2)].max(0.0).sqrt() };
        judged(second, bends[1], sigma_s, limits)
    };
    Pair { first, second }
}

/// The contact, if it is known well enough. An error e along the contour adds to that across it in second order, by half the
/// curvature times e^2; 3/4 is the mean of the square for a normal variable, (1/2)^2 times 3.
fn judged(mut touch: Touch, bend: f64, sigma_s: f64, limits: &Limits) -> Result<Touch, Unresolved> {
    let (sin, cos) = touch.alpha.sin_cos();
    let (tangent, normal) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let along = variance(&tangent, &touch.covariance);
    touch.covariance += normal * normal.transpose() * (FOURTH_MOMENT * (bend * along).powi(2));
    let across = touch.sigma_normal();
    if !(across.is_finite() && touch.x.is_finite() && touch.y.is_finite()) {
        return Err(Unresolved::Inconsistent);
    }
    if across > limits.across {
        return Err(Unresolved::TooNoisy { sigma: across });
    }
    if sigma_s > limits.along {
        return Err(Unresolved::TooNoisy { sigma: sigma_s });
    }
    Ok(touch)
}
