//! A contact of the side and one of the tip.

use super::bent::{alpha_of, bent, push, whole};
use nalgebra::Vector2;
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Pose, Reactions};
use std::f64::consts::PI;

/// Most steps of the secant method, and the moment at the tip at which it has converged, EI/L.
const STEPS: usize = 20;
const SETTLED: f64 = 1e-9;
/// First force that is tried, and the largest, as shares of the force at the clamp.
const FIRST: f64 = 0.1;
const LARGEST: f64 = 1e3;

/// The contacts at arc length `s` (m) and at the tip that give these reactions (N, N m): of the force at `s`, that for which the moment vanishes
/// at the tip. None where there is none, or where the tip would be pulled.
pub(super) fn with_tip<R: PhysicalRod>(rod: &R, pose: Pose, reactions: Reactions, s: f64) -> Option<[Contact; 2]> {
    let units = rod.units();
    let whole = whole(&reactions);
    // up to there the shape depends on the reactions alone
    let at = bent(rod, pose, &reactions, &[(units.length, whole)])?.at(s);
    let normal = push(at.phi);
    let with = |force: f64| bent(rod, pose, &reactions, &[(s, normal * force), (units.length, whole - normal * force)]);
    let (mut before, mut force) = (0.0, FIRST * whole.norm());
    let mut moment_before = with(before)?.moment(units.length);
    for _ in 0..STEPS {
        let shape = with(force)?;
        let moment = shape.moment(units.length);
        if moment.abs() < SETTLED * units.moment {
            let (tip, of_tip) = (shape.at(units.length), whole - normal * force);
            let is_pulled = of_tip.dot(&Vector2::new(tip.phi.cos(), tip.phi.sin())) > 0.0;
            let side = Contact {
                object: 0,
                piece: 0,
                kind: ContactKind::Tangent,
                s,
                x: at.x,
                y: at.y,
                alpha: if force > 0.0 { at.phi } else { at.phi + PI },
                force: force.abs(),
                friction: None,
            };
            let (kind, s, alpha, force) = (ContactKind::Tip, units.length, alpha_of(of_tip), of_tip.norm());
            return (!is_pulled).then_some([side, Contact { kind, s, x: tip.x, y: tip.y, alpha, force, ..side }]);
        }
        let next = force - moment * (force - before) / (moment - moment_before);
        if !next.is_finite() || next.abs() > LARGEST * whole.norm() {
            return None;
        }
        (before, moment_before, force) = (force, moment, next);
    }
    None
}
