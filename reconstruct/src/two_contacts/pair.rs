//! The two contacts of each sample, from the solution of a run.

use super::bend::bends;
use super::conditions::{two_by, two_moving};
use super::displaced::Spread;
use super::part::{INSTANTS, Local, Part, place};
use super::run::Resolved;
use super::unknowns::{UNKNOWNS, Unknown};
use super::unresolved::Unresolved;
use crate::numeric::variance;
use crate::point::{Clamp, CrossSection, Inverse, Touch, normal_part};
use nalgebra::{DVector, Matrix2, Matrix6, SMatrix, SVector, Vector2, Vector3};
use rod_core::Dual;

/// Speed along the rod per way of the clamp, below which matter may stand still: the error of series at their ends. Larger: contacts that
/// slide slowly are given up.
const SLOW: f64 = 1e-3;
/// Standard deviations by which the first contact must slide. Larger: more contacts are given up in noise; smaller: a contact that sticks
/// passes for one that slides.
const SIGMAS: f64 = 3.0;

/// Whether both contacts slide against friction along a part, on the mean: between kinks a contact slides or sticks all the way. Always
/// without friction.
pub(super) fn slides<I: Inverse>(rod: &I, part: &Part, x: &DVector<f64>) -> bool {
    if part.series.friction == 0.0 {
        return true;
    }
    let against = -part.series.friction.signum();
    let speeds = (0..INSTANTS).map(|k| along(rod, &part.local(x, place(k))));
    let sum = speeds.fold([0.0; 2], |sum, two| [0, 1].map(|i| sum[i] + against * two[i]));
    let [first, second] = sum.map(|sum| sum / INSTANTS as f64);
    first > SLOW + SIGMAS * sigma_of_first(rod, part, &part.local(x, 0.0)) && second > SLOW
}

/// The speeds of the rod's matter along the rod at both contacts, per way of the clamp.
fn along<I: Inverse>(rod: &I, local: &Local) -> [f64; 2] {
    let two = two_moving(rod, local);
    // contacts move along the rod besides
    [(&two.first, Unknown::S1), (&two.second, Unknown::S2)].map(|(section, s)| {
        let (sin, cos) = section.phi.value.sin_cos();
        cos * section.x.derivatives[0] + sin * section.y.derivatives[0] - local.rates[s]
    })
}

/// Standard deviation of the first one's mean speed by the noise of the rates: the mean of a rate is the difference of the values at both
/// ends, to which all odd polynomials contribute 1.
fn sigma_of_first<I: Inverse>(rod: &I, part: &Part, local: &Local) -> f64 {
    let reactions = Vector3::from(Unknown::REACTIONS.map(|unknown| local.values[unknown]));
    let Local { natural, friction, .. } = *local;
    let clamp = Clamp { pose: local.pose[0], reactions, natural, friction };
    let (section, gradient) = rod.gradient_at(&clamp, local.values[Unknown::S1]);
    let (sin, cos) = section.phi.sin_cos();
    let series = &part.series;
    let mean = DVector::from_fn(series.terms(), |j, _| if j % 2 == 1 { 1.0 / series.interval.half } else { 0.0 });
    let spread = mean.dot(&(&series.inverse * &mean));
    let by = |c: usize| cos * gradient.by_reactions[(0, c)] + sin * gradient.by_reactions[(1, c)];
    (0..3).map(|c| by(c).powi(2) * series.variance[c] * spread).sum::<f64>().sqrt()
}

/// A force vanishes where it is within this many standard deviations of zero.
const VANISHES: f64 = 3.0;
/// Standard deviation across the contour by an error along it, in units of the curvature and the variance along. The error across is half
/// the curvature times the square of that along, 0.87 in the root mean square. It is not normal: with 1.3 it exceeds 6 of these
/// standard deviations once in 10^4.
const SECOND_ORDER: f64 = 1.3;
/// The first contact exists if its force exceeds this many standard deviations somewhere in the stretch. Larger: short weak contacts are
/// given up; smaller: noise may put a contact where there is none.
const PRESENT: f64 = 6.0;
const F1: usize = Unknown::F1 as usize;
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

impl Pair {
    /// No contact, for this reason.
    pub fn without(why: Unresolved) -> Self {
        Self { first: Err(why), second: Err(why) }
    }

    fn with_systematic(self, covariance: [Matrix2<f64>; 2]) -> Self {
        let [first, second] = covariance;
        Self {
            first: self.first.map(|touch| touch.with_systematic(first)),
            second: self.second.map(|touch| touch.with_systematic(second)),
        }
    }
}

/// The contacts of the samples at these path parameters of a part, appended to `pairs`.
///
/// `spread` is the covariance of the contacts by errors that all samples share.
pub(super) fn answer<I: Inverse>(
    rod: &I,
    found: &Resolved,
    part: &Part,
    tau: &[f64],
    limits: &Limits,
    spread: &Spread,
    pairs: &mut Vec<Pair>,
) {
    let x = &found.solution.x;
    let covariances: Vec<Matrix6<f64>> = (0..INSTANTS)
        .map(|k| part.covariance(&part.local(x, place(k)), &found.solution.covariance) * found.excess)
        .collect();
    let bends = bends(rod, found, part);
    let strength = |k: usize| {
        let f1 = part.local(x, place(k)).values[Unknown::F1];
        f1 / covariances[k][(F1, F1)].max(f64::MIN_POSITIVE).sqrt()
    };
    // the contact pushes from one side along the whole stretch
    let strongest = (0..INSTANTS).map(strength).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    if strongest.abs() < PRESENT {
        pairs.extend(tau.iter().map(|_| Pair::without(Unresolved::FirstForceVanishes)));
        return;
    }
    if !slides(rod, part, x) {
        pairs.extend(tau.iter().map(|_| Pair::without(Unresolved::Sticks)));
        return;
    }
    for &tau in tau {
        let t = part.series.interval.local(tau);
        let u = (0.5 * (t.clamp(-1.0, 1.0) + 1.0)) * (INSTANTS - 1) as f64;
        let k = (u as usize).min(INSTANTS - 2);
        let w = u - k as f64;
        let local = part.local(x, t);
        // beyond the samples of the series, at the ends of the stretch, its error grows fast
        let covariance = if t.abs() > 1.0 {
            part.covariance(&local, &found.solution.covariance) * found.excess
        } else {
            covariances[k] * (1.0 - w) + covariances[k + 1] * w
        };
        let bend = [0, 1].map(|i| bends[k][i].max(bends[k + 1][i]));
        let shared = [0, 1].map(|i| spread[k][i] * (1.0 - w) + spread[k + 1][i] * w);
        let mut pair = pair(rod, part, &local, &covariance, bend, limits);
        if local.values[Unknown::F1] * strongest.signum() < VANISHES * covariance[(F1, F1)].max(0.0).sqrt() {
            pair.first = Err(Unresolved::FirstForceVanishes);
        }
        pairs.push(pair.with_systematic(shared));
    }
}

fn pair<I: Inverse>(
    rod: &I,
    part: &Part,
    local: &Local,
    covariance: &Matrix6<f64>,
    bends: [f64; 2],
    limits: &Limits,
) -> Pair {
    let two = two_by(rod, local);
    let bend = |s: &CrossSection<Dual<f64, UNKNOWNS>>| {
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
        force: f1.abs() * local.friction.hypot(1.0),
        covariance: spread1,
        systematic: Matrix2::zeros(),
    };
    let kappa = rod.curvature(&two.first.map(|number| number.value), first.s);
    let first = judged(first, bends[0].abs() + kappa.abs(), covariance[(S1, S1)].max(0.0).sqrt(), limits);

    let [a, b] = two.force;
    let [normal_a, normal_b] = normal_part([a.value, b.value], two.second.phi.value.sin_cos(), local.friction);
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
        alpha: normal_b.atan2(normal_a),
        force,
        covariance: spread2,
        systematic: Matrix2::zeros(),
    };
    let second = if force < VANISHES * sigma_force {
        Err(Unresolved::ForceVanishes)
    } else {
        let sigma_s = if part.tip { 0.0 } else { covariance[(S2, S2)].max(0.0).sqrt() };
        judged(second, bends[1], sigma_s, limits)
    };
    Pair { first, second }
}

/// The contact, if it is known well enough. An error along the contour adds to that across it in second order, by the curvature; at most
/// the error itself, as at a vertex.
fn judged(mut touch: Touch, bend: f64, sigma_s: f64, limits: &Limits) -> Result<Touch, Unresolved> {
    let (sin, cos) = touch.alpha.sin_cos();
    let (tangent, normal) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let along = variance(&tangent, &touch.covariance);
    let bent = along.max(0.0).sqrt().min(SECOND_ORDER * bend * along.max(0.0));
    touch.covariance += normal * normal.transpose() * (bent * bent);
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
