//! The stretches of a scan in which the rod touches nothing, found from the reactions alone: there they do not change, whatever the
//! bias of the sensor.

use super::source::{Errors, Source};
use crate::numeric::{CHANCE, NormalEquations};
use crate::phase::{Break, parts};
use crate::scan::{Noise, Track};
use nalgebra::{Vector2, Vector3};
use std::ops::Range;

/// Fewest samples of a free stretch. Fewer: a contact that has just begun is taken for one.
const FEWEST: usize = 40;
/// How often the first and the last part of a scan are halved where they are not free as a whole, because the kink at the begin of a
/// contact is small.
const HALVINGS: usize = 6;

/// The free stretches in order. `sigmas` are the standard deviations of the errors before anything is known.
pub(super) fn free_stretches(track: &Track, noise: &Noise, breaks: &[Break], sigmas: &Errors) -> Vec<Range<usize>> {
    let parts = parts(track.len(), breaks);
    let last = parts.len() - 1;
    let mut found: Vec<Range<usize>> = Vec::new();
    for (k, (part, _)) in parts.into_iter().enumerate() {
        let mut tried = part.clone();
        for _ in 0..=HALVINGS {
            if tried.len() < FEWEST {
                break;
            }
            if is_free(track, noise, tried.clone(), sigmas) {
                found.push(tried);
                break;
            }
            // the rod is free at the outer end, if at all
            tried = match k {
                0 => tried.start..tried.start + tried.len() / 2,
                _ if k == last => tried.start + tried.len().div_ceil(2)..tried.end,
                _ => break,
            };
        }
    }
    found
}

/// Whether reactions and their slopes are within bias and drift, and straight.
fn is_free(track: &Track, noise: &Noise, part: Range<usize>, sigmas: &Errors) -> bool {
    let (from, to) = (track.tau[part.start], track.tau[part.end - 1]);
    let whole = track.tau[track.len() - 1] - track.tau[0];
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut equations = NormalEquations::<2, 3>::default();
    let clamps = &track.clamps[part.clone()];
    for (tau, clamp) in track.tau[part.clone()].iter().zip(clamps) {
        equations.add(&Vector2::new(1.0, (tau - centre) / half), &clamp.reactions, 1.0);
    }
    let Some(normal) = equations.factor() else { return false };
    let line = normal.solve(&equations.right);
    let inverse = normal.inverse();
    let mut squares = Vector3::zeros();
    for (tau, clamp) in track.tau[part.clone()].iter().zip(clamps) {
        let off = clamp.reactions - line.row(0).transpose() - line.row(1).transpose() * ((tau - centre) / half);
        squares += off.component_mul(&off);
    }
    let freedom = part.len() as f64 - 2.0;
    (0..3).all(|c| {
        let of = |first: Source| sigmas[first as usize + c];
        let variance = noise.variance[c] * noise.long_run[c];
        let level = CHANCE
            * (of(Source::BiasF0x).hypot(0.5 * of(Source::DriftF0x)).hypot(of(Source::BowF0x)).powi(2)
                + variance * inverse[(0, 0)])
                .sqrt();
        // the slope of half a sine is pi at its ends
        let drift = of(Source::DriftF0x).hypot(std::f64::consts::PI * of(Source::BowF0x)) * half / whole;
        let slope = CHANCE * (drift * drift + variance * inverse[(1, 1)]).sqrt();
        let rest = noise.variance[c] * (1.0 + CHANCE * (2.0 * noise.long_run[c] / freedom).sqrt());
        // a curved drift bends the line, too
        let bend = of(Source::BowF0x) * (half / whole).powi(2) * 10.0;
        line[(0, c)].abs() <= level && line[(1, c)].abs() <= slope && squares[c] / freedom <= rest + bend * bend
    })
}
