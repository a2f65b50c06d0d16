//! Stretches with several contacts, resolved.

use super::bend::UNSURE;
use super::ends::{Beside, End};
use super::pair::{Limits, Pair, answer};
use super::run::solve;
use super::series::Series;
use super::unresolved::Unresolved;
use crate::numeric::propagated;
use crate::phase::Label;
use crate::point::MomentZero;
use crate::scan::{Noise, Track};
use nalgebra::{DVector, Matrix2x3, Matrix3, Vector2};
use std::ops::Range;

/// Fewest samples of a stretch: fewer do not determine rates.
const FEWEST_SAMPLES: usize = 16;
/// Samples of a neighbouring stretch from which its contact is computed, unless the stretch itself has more.
const BESIDE: usize = 200;

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

/// Both contacts of each sample of a run of consecutive stretches, dimensionless. `before` and `after` are the neighbouring
/// stretches with one contact, if the reactions do not jump there.
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
            if range.len() < FEWEST_SAMPLES { None } else { Series::through(track, range, noise) }
        })
        .collect();
    let mut k = 0;
    while k < pieces.len() {
        let end = (k..pieces.len()).find(|&j| fitted[j].is_none()).unwrap_or(pieces.len());
        if end == k {
            let error = Unresolved::TooShort { samples: inside(&pieces[k].range).len(), least: FEWEST_SAMPLES };
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
    let count = range.len().min(like.max(BESIDE));
    let range = if side == 0 { range.end - count..range.end } else { range.start..range.start + count };
    let tau = track.tau[if side == 0 { range.end - 1 } else { range.start }];
    let series = Series::through(track, range, noise)?;
    let t = series.interval.local(tau);
    let [clamp, _] = series.clamps(t);
    let p = DVector::from_vec(series.interval.basis(t, series.terms()).0);
    let covariance = Matrix3::from_diagonal(&(series.variance * p.dot(&(&series.inverse * &p))));
    let found = MomentZero::of(&clamp, &covariance).ok()?;
    let normal = found.normal();
    let by: Matrix2x3<f64> = found.by_reactions.fixed_rows::<2>(0).into_owned();
    let sigma = propagated(&(normal.transpose() * by), &covariance).x.sqrt();
    let sigma_s = propagated(&found.s_by_reactions.transpose(), &covariance).x.sqrt();
    let way = (edge - tau).abs();
    let place = Vector2::new(found.section.x, found.section.y);
    // the other end of the neighbour's samples
    let far = MomentZero::of(&series.clamps(-t)[0], &covariance).ok();
    let bend = far.map_or(f64::INFINITY, |far| {
        let passed = (Vector2::new(far.section.x, far.section.y) - place).norm();
        let least = passed - UNSURE * (sigma_s * std::f64::consts::SQRT_2);
        let turned = far.normal().perp(&normal).abs();
        if least > 0.0 { turned / least } else { f64::INFINITY }
    });
    Some(Beside { last: End::Last { place, normal, sigma, way, bend }, s: found.s, sigma_s, way, bend })
}
