//! Both contacts of a rod that is held by two, from a scan.
//!
//! Up to its first contact the rod is known from the reactions alone. Along a scan these arcs touch the contour: there
//! their normal speed vanishes (`envelope`). Force and second contact follow: the rod is without moment there,
//! and that contact, too, moves along its own tangent. All this is asked for at once, in least squares over a whole run
//! of stretches: reactions, arc lengths and the first force are series in the path parameter that agree with what was
//! measured as far as its noise allows.

mod beyond;
mod conditions;
mod envelope;
mod run;
mod series;
mod system;
#[cfg(test)]
mod tests;
mod trail;
mod unresolved;

pub use unresolved::Unresolved;

use crate::phase::label::Label;
use crate::point::clamp::spread;
use crate::point::single::MomentZero;
use crate::point::touch::Touch;
use crate::scan::local_cubic::Noise;
use crate::scan::track::Track;
use conditions::{INPUTS, two};
use nalgebra::{DVector, Matrix2x3, Matrix3, Matrix6, SMatrix, SVector, Vector2};
use rod_core::Dual;
use run::{Beside, Found, solve};
use series::Series;
use std::ops::Range;
use system::{End, Local, Part};

/// Fewest samples of a stretch: rates need as many.
const LEAST: usize = 16;
/// Instants of a stretch at which covariances are worked out; they are interpolated in between.
const INSTANTS: usize = 33;
/// A force within so many standard deviations of nothing is nothing.
const SIGMAS: f64 = 3.0;

/// A stretch with several contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Piece {
    pub range: Range<usize>,
    pub label: Label,
}

/// A stretch with one contact beside a run, without a jump in between.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Neighbour {
    pub range: Range<usize>,
    pub label: Label,
}

/// What is good enough, in lengths of the rod, and how well the ends of stretches are known.
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

/// What is known of the two contacts of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub first: Result<Touch, Unresolved>,
    pub second: Result<Touch, Unresolved>,
}

/// Both contacts of every sample of a run of stretches, dimensionless. The run is consecutive; `before` and `after` are
/// the stretches with one contact that it joins without a jump.
pub(crate) fn resolve(
    track: &Track,
    noise: &Noise,
    pieces: &[Piece],
    before: Option<Neighbour>,
    after: Option<Neighbour>,
    limits: &Limits,
) -> Vec<Pair> {
    let mut pairs = Vec::with_capacity(pieces.iter().map(|p| p.range.len()).sum());
    let inside = |range: &Range<usize>| {
        let margin = limits.margin.min(range.len() / 8);
        range.start + margin..range.end - margin
    };
    let fitted: Vec<Option<Series>> = pieces
        .iter()
        .map(|piece| {
            let range = inside(&piece.range);
            if range.len() < LEAST { None } else { Series::through(track, range, noise) }
        })
        .collect();
    let mut k = 0;
    while k < pieces.len() {
        let end = (k..pieces.len()).find(|&j| fitted[j].is_none()).unwrap_or(pieces.len());
        if end == k {
            let error = Unresolved::TooShort { samples: inside(&pieces[k].range).len(), least: LEAST };
            pairs.extend(pieces[k].range.clone().map(|_| Pair { first: Err(error), second: Err(error) }));
            k += 1;
            continue;
        }
        let at_end = |neighbour: &Option<Neighbour>, side: usize, here: bool| {
            let neighbour = neighbour.as_ref().filter(|_| here)?;
            let piece = &pieces[if side == 0 { k } else { end - 1 }];
            let own = inside(&piece.range);
            let edge = track.tau[if side == 0 { own.start } else { own.end - 1 }];
            beside(track, noise, &inside(&neighbour.range), side, own.len(), edge)
        };
        let ends = [at_end(&before, 0, k == 0), at_end(&after, 1, end == pieces.len())];
        let stretches = (k..end).filter_map(|j| Some((fitted[j].clone()?, pieces[j].label.tip()))).collect::<Vec<_>>();
        match solve(stretches, ends) {
            Ok(found) => {
                for (part, piece) in found.parts.iter().zip(&pieces[k..end]) {
                    answer(&found, part, &track.tau[piece.range.clone()], limits, &mut pairs);
                }
            }
            Err(error) => {
                let samples = pieces[end - 1].range.end - pieces[k].range.start;
                pairs.extend((0..samples).map(|_| Pair { first: Err(error), second: Err(error) }));
            }
        }
        k = end;
    }
    pairs
}

/// The neighbour's contact at its end next to the run.
fn beside(track: &Track, noise: &Noise, range: &Range<usize>, side: usize, like: usize, edge: f64) -> Option<Beside> {
    let count = range.len().min(like.max(200));
    let range = if side == 0 { range.end - count..range.end } else { range.start..range.start + count };
    let tau = track.tau[if side == 0 { range.end - 1 } else { range.start }];
    let series = Series::through(track, range, noise)?;
    let t = series.span.local(tau);
    let [clamp, _] = series.clamps(t);
    let p = DVector::from_vec(series.span.basis(t, series.terms()).0);
    let covariance = Matrix3::from_diagonal(&(series.variance * p.dot(&(&series.inverse * &p))));
    let found = MomentZero::of(&clamp, &covariance).ok()?;
    let normal = found.normal();
    let by: Matrix2x3<f64> = found.by_reactions.fixed_rows::<2>(0).into_owned();
    let sigma = spread(&(normal.transpose() * by), &covariance).x.sqrt();
    let sigma_s = spread(&found.s_by_reactions.transpose(), &covariance).x.sqrt();
    let way = (edge - tau).abs();
    let place = Vector2::new(found.section.x, found.section.y);
    Some(Beside { last: End::Last { place, normal, sigma, way }, s: found.s, sigma_s, way })
}

/// Answers for the samples at these places of a part.
fn answer(found: &Found, part: &Part, tau: &[f64], limits: &Limits, pairs: &mut Vec<Pair>) {
    let x = &found.solution.x;
    let place = |k: usize| -1.0 + 2.0 * k as f64 / (INSTANTS - 1) as f64;
    let covariances: Vec<Matrix6<f64>> = (0..INSTANTS)
        .map(|k| part.covariance(&part.local(x, place(k)), &found.solution.covariance) * found.excess)
        .collect();
    let bends = bends(part, x, place);
    for &tau in tau {
        let t = part.series.span.local(tau);
        let u = (0.5 * (t.clamp(-1.0, 1.0) + 1.0)) * (INSTANTS - 1) as f64;
        let k = (u as usize).min(INSTANTS - 2);
        let w = u - k as f64;
        let covariance = covariances[k] * (1.0 - w) + covariances[k + 1] * w;
        let local = part.local(x, t);
        pairs.push(pair(part, &local, &covariance, bends, limits));
    }
}

/// By how much the contour bends where the two contacts pass, on the average: what an error along it costs across.
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
    [0, 1].map(|i| turned[i] / passed[i].max(1e-3))
}

fn pair(part: &Part, local: &Local, covariance: &Matrix6<f64>, bends: [f64; 2], limits: &Limits) -> Pair {
    let values: [Dual<f64, INPUTS>; INPUTS] = std::array::from_fn(|i| Dual::variable(local.values[i], i));
    let two = two(std::array::from_fn(|i| Dual::constant(local.pose[0][i])), &values);
    let bend = |s: &rod_core::Section<Dual<f64, INPUTS>>| {
        let by =
            SMatrix::<f64, 2, INPUTS>::from_fn(|r, c| if r == 0 { s.x.derivatives[c] } else { s.y.derivatives[c] });
        (s.x.value, s.y.value, by * covariance * by.transpose())
    };
    let f1 = local.values[4];
    let turn = |alpha: f64| alpha.sin().atan2(alpha.cos());
    let (x, y, spread1) = bend(&two.first);
    let phi = two.first.phi.value;
    let alpha = turn(if f1 < 0.0 { phi + std::f64::consts::PI } else { phi });
    let first = Touch { s: local.values[3], x, y, alpha, force: f1.abs(), covariance: spread1 };
    let kappa = two.first.kappa.value;
    let first = judged(first, bends[0].abs() + kappa.abs(), covariance[(3, 3)].max(0.0).sqrt(), limits);

    let [a, b] = two.force;
    let force = a.value.hypot(b.value);
    let by_force = SVector::<f64, INPUTS>::from_fn(|i, _| {
        (a.value * a.derivatives[i] + b.value * b.derivatives[i]) / force.max(f64::MIN_POSITIVE)
    });
    let sigma_force = crate::point::clamp::variance(&by_force, covariance).sqrt();
    let (x, y, spread2) = bend(&two.second);
    let second = Touch { s: local.values[5], x, y, alpha: b.value.atan2(a.value), force, covariance: spread2 };
    let second = if force < SIGMAS * sigma_force {
        Err(Unresolved::ForceVanishes)
    } else {
        let sigma_s = if part.tip { 0.0 } else { covariance[(5, 5)].max(0.0).sqrt() };
        judged(second, bends[1], sigma_s, limits)
    };
    Pair { first, second }
}

/// The contact, if it is known well enough: an error along the contour, which bends away from where the contact is
/// taken to move, is one across it to second order.
fn judged(mut touch: Touch, bend: f64, sigma_s: f64, limits: &Limits) -> Result<Touch, Unresolved> {
    let (sin, cos) = touch.alpha.sin_cos();
    let (tangent, normal) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let along = crate::point::clamp::variance(&tangent, &touch.covariance);
    touch.covariance += normal * normal.transpose() * (0.75 * (bend * along).powi(2));
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
