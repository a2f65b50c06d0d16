//! How far errors that all samples share displace the two contacts of a run, to first order.
//!
//! Displaced samples change the right-hand side of the least squares. One Gauss-Newton step from the solution leads to the displaced one.

use super::choice::End;
use super::conditions::two;
use super::part::{INSTANTS, Part, place};
use super::run::Resolved;
use super::single::Single;
use super::system::System;
use crate::least_squares::Equations;
use crate::point::Inverse;
use crate::systematic::{Correction, DISPLACED};
use nalgebra::{DVector, Matrix2, Vector2};

/// At the instants of a part the covariance of the first and of the second contact, dimensionless.
pub(super) type Spread = [[Matrix2<f64>; 2]; INSTANTS];

/// For each part the covariance of its contacts by displacements of one standard deviation each; 0 where a step has no solution.
/// `beside` are the single contacts that the run was solved with.
pub(super) fn displaced<I: Inverse>(
    rod: &I,
    found: &Resolved,
    beside: &[Option<Single>; 2],
    by: &[Correction],
) -> Vec<Spread> {
    let mut spread = vec![[[Matrix2::zeros(); 2]; INSTANTS]; found.parts.len()];
    if by.is_empty() {
        return spread;
    }
    let x = &found.solution.x;
    let solved = System { rod, parts: &found.parts, ends: found.ends, tolerance: found.tolerance };
    let weights = solved.weights(x);
    // what the iteration left
    let Some(rest) = solved.normal(x, &weights).step() else { return spread };
    let here: Vec<_> = found.parts.iter().map(|part| contacts(rod, part, x)).collect();
    for displacement in by {
        let move_part = |part: &Part| Part { series: part.series.displaced(displacement), ..part.clone() };
        let parts: Vec<Part> = found.parts.iter().map(move_part).collect();
        let ends = [0, 1].map(|side| {
            let beside = || beside[side].as_ref()?.displaced(displacement).contact(rod);
            match found.ends[side] {
                End::Open => Some(End::Open),
                End::Last { .. } => Some(beside()?.last),
                End::First { .. } => Some(beside()?.first()),
            }
        });
        let [Some(first), Some(last)] = ends else { continue };
        let moved = System { rod, parts: &parts, ends: [first, last], tolerance: found.tolerance };
        let Some(step) = moved.normal(x, &weights).step() else { continue };
        let there = x + (step - &rest);
        for ((part, here), spread) in parts.iter().zip(&here).zip(&mut spread) {
            for ((here, there), spread) in here.iter().zip(contacts(rod, part, &there)).zip(spread) {
                for ((here, there), spread) in here.iter().zip(there).zip(spread) {
                    let by = (there * displacement.length() - here) / DISPLACED;
                    if by.iter().all(|v| v.is_finite()) {
                        *spread += by * by.transpose();
                    }
                }
            }
        }
    }
    spread
}

/// The two contacts of a part at its instants.
fn contacts<I: Inverse>(rod: &I, part: &Part, x: &DVector<f64>) -> [[Vector2<f64>; 2]; INSTANTS] {
    std::array::from_fn(|k| {
        let local = part.local(x, place(k));
        let two = two(rod, &local);
        [&two.first, &two.second].map(|section| Vector2::new(section.x, section.y))
    })
}
