//! Where the least squares of a run start from.

use super::beyond::Beyond;
use super::choice::{Choice, End};
use super::part::Part;
use super::trail::Trail;
use super::unknowns::Unknown;
use crate::numeric::legendre;
use crate::point::{Inverse, normal_part};
use nalgebra::{DMatrix, DVector};

/// Instants of a stretch at which forces are guessed, its ends among them.
const INSTANTS: usize = 13;
/// Largest change of the force from one instant to the next: relative to the forces, and absolutely (EI/L^2). A root farther away
/// belongs to another equilibrium.
const JUMP: (f64, f64) = (0.3, 0.5);
/// Largest force that is looked at where none is known: relative to the force at the clamp, and absolutely (EI/L^2).
const LARGEST: (f64, f64) = (4.0, 1.0);
/// Number of forces that are looked at from minus to plus the largest.
const FORCES: usize = 81;

/// The t of an instant.
fn instant(k: usize) -> f64 {
    -1.0 + 2.0 * k as f64 / (INSTANTS - 1) as f64
}

/// Coefficients to start the least squares from: arc lengths along the trails, and forces from the ends of the run; none where
/// the forces do not determine a series.
pub(super) fn guess<I: Inverse>(rod: &I, parts: &[Part], choice: &Choice) -> Option<DVector<f64>> {
    let mut x = DVector::zeros(parts.iter().map(Part::width).sum());
    let count = parts.len();
    // the force at the ends of each part, as far as it is known
    let mut known: Vec<[Option<f64>; 2]> = vec![[None; 2]; count];
    for (side, end) in choice.ends.iter().enumerate() {
        let k = if side == 0 { 0 } else { count - 1 };
        known[k][side] = match *end {
            End::Open => None,
            End::Last { .. } => Some(0.0),
            End::First { s, .. } => {
                let [clamp, _] = parts[k].series.clamps(if side == 0 { -1.0 } else { 1.0 });
                let [a, b] = clamp.force();
                let phi = rod.at(&clamp, s).phi;
                let [normal_a, normal_b] = normal_part([a, b], phi.sin_cos(), clamp.friction);
                Some(normal_a.hypot(normal_b) * (a * phi.cos() + b * phi.sin()).signum())
            }
        };
    }
    let mut forces: Vec<Vec<f64>> = vec![Vec::new(); count];
    for (k, part) in parts.iter().enumerate().filter(|(_, p)| p.tip) {
        forces[k] = by_tip(rod, part, &choice.trails[k], known[k]);
        let (first, last) = (forces[k][0], forces[k][INSTANTS - 1]);
        if k > 0 {
            known[k - 1][1] = Some(first);
        }
        if k + 1 < count {
            known[k + 1][0] = Some(last);
        }
    }
    for (k, part) in parts.iter().enumerate() {
        if !part.tip {
            let (from, to) = match known[k] {
                [Some(a), Some(b)] => (a, b),
                [Some(a), None] | [None, Some(a)] => (a, a),
                _ => (0.0, 0.0),
            };
            forces[k] = (0..INSTANTS).map(|i| 0.5 * ((1.0 - instant(i)) * from + (1.0 + instant(i)) * to)).collect();
        }
        let series = &part.series;
        let n = series.terms();
        for unknown in Unknown::REACTIONS {
            x.rows_mut(part.columns(unknown).0, n).copy_from(&series.reactions.column(unknown as usize));
        }
        let trail = choice.trails[k];
        let straight = |x: &mut DVector<f64>, at: usize, ends: [f64; 2]| {
            x[at] = 0.5 * (ends[0] + ends[1]);
            x[at + 1] = 0.5 * (ends[1] - ends[0]);
        };
        straight(&mut x, part.columns(Unknown::S1).0, trail.ends);
        let (at, terms) = part.columns(Unknown::F1);
        x.rows_mut(at, terms).copy_from(&fitted(&forces[k], terms)?);
        if !part.tip {
            let end = |side: usize| -> Option<f64> {
                let other = if side == 0 { k.checked_sub(1) } else { Some(k + 1).filter(|&k| k < count) };
                if other.is_some_and(|other| parts[other].tip) {
                    return Some(1.0);
                }
                let [clamp, _] = series.clamps(if side == 0 { -1.0 } else { 1.0 });
                let last = matches!(choice.ends[side], End::Last { .. });
                last.then(|| rod.first(&clamp).ok().map(|m| m.s)).flatten()
            };
            let beyond = |f: f64, t: f64| {
                let [clamp, _] = series.clamps(t);
                Beyond::new(rod, &clamp, trail.at(t)).second(f).filter(|s| *s < 1.0)
            };
            let ends = match [end(0), end(1)] {
                [Some(a), Some(b)] => [a, b],
                // the rod slides past both contacts
                [Some(a), None] => [a, a + trail.ends[1] - trail.ends[0]],
                [None, Some(b)] => [b + trail.ends[0] - trail.ends[1], b],
                _ => {
                    let s = beyond(forces[k][INSTANTS / 2], 0.0).unwrap_or(0.5 * (1.0 + trail.at(0.0)));
                    [s, s]
                }
            };
            straight(&mut x, part.columns(Unknown::S2).0, ends);
        }
    }
    Some(x)
}

/// The Legendre series of this many terms that fits forces at the instants best.
fn fitted(forces: &[f64], terms: usize) -> Option<DVector<f64>> {
    let mut rows = DMatrix::zeros(terms, INSTANTS);
    (0..INSTANTS).for_each(|i| legendre::values(instant(i), rows.column_mut(i).as_mut_slice()));
    let rows = rows.transpose();
    let forces = DVector::from_column_slice(forces);
    Some(rows.tr_mul(&rows).cholesky()?.solve(&rows.tr_mul(&forces)))
}

/// Forces of the first contact for which the moment at the tip vanishes, followed from the end at which the force is known.
fn by_tip<I: Inverse>(rod: &I, part: &Part, trail: &Trail, known: [Option<f64>; 2]) -> Vec<f64> {
    let beyond = |k: usize| {
        let [clamp, _] = part.series.clamps(instant(k));
        Beyond::new(rod, &clamp, trail.at(instant(k)))
    };
    let mut forces = vec![0.0; INSTANTS];
    let backwards = known[0].is_none();
    let mut guess = known[0].or(known[1]).unwrap_or_else(|| scanned(&beyond(INSTANTS - 1)));
    for k in 0..INSTANTS {
        let k = if backwards { INSTANTS - 1 - k } else { k };
        let reach = JUMP.0 * (beyond(k).force[0].hypot(beyond(k).force[1]) + guess.abs()) + JUMP.1;
        if let Some(f) = beyond(k).force_of_tip(guess).filter(|f| (f - guess).abs() < reach) {
            guess = f;
        }
        forces[k] = guess;
    }
    forces
}

/// The smallest force for which the moment at the tip vanishes and the contact there pushes.
fn scanned<I: Inverse>(beyond: &Beyond<'_, I>) -> f64 {
    let size = LARGEST.0 * beyond.force[0].hypot(beyond.force[1]) + LARGEST.1;
    let force = |k: usize| -size + 2.0 * size * k as f64 / (FORCES - 1) as f64;
    let mut best: Option<f64> = None;
    let mut before = beyond.tip(force(0)).0.bend;
    for k in 1..FORCES {
        let here = beyond.tip(force(k)).0.bend;
        if here * before <= 0.0
            && let Some(f) = beyond.force_of_tip(0.5 * (force(k) + force(k - 1)))
            && beyond.pushes(f, 0.0)
            && best.is_none_or(|b| f.abs() < b.abs())
        {
            best = Some(f);
        }
        before = here;
    }
    best.unwrap_or(0.0)
}
