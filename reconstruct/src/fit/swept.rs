//! Where the rod was, no object is.

use super::blocks::Blocks;
use crate::systematic::{Correction, Errors, still};
use nalgebra::Vector2;
use rod_contact::{Contact, State};
use rod_core::{Elastica, Load, PhysicalRod};

/// Shapes of the rod that are looked at, and points of each. More: more time.
const SHAPES: usize = 200;
const POINTS: usize = 32;
/// How far inside a contour the rod must have been, rod lengths, and how often: noise and errors put single shapes there.
const INSIDE: f64 = 0.004;
const OFTEN: usize = 2;

/// Shapes of the rod during a recording, in rod lengths.
#[derive(Clone, Debug, Default)]
pub(super) struct Swept {
    shapes: Vec<Vec<Vector2<f64>>>,
}

impl Swept {
    /// Of the blocks whose contacts are known.
    pub fn of<R: PhysicalRod>(rod: &R, blocks: &Blocks, errors: &Errors) -> Self {
        let Some(correction) = Correction::new(blocks.frame, errors) else { return Self::default() };
        let units = rod.units();
        let known: Vec<_> = blocks.blocks.iter().filter(|block| !block.contacts.is_empty()).collect();
        let shape = |block: &&super::blocks::Block| {
            let clamp = correction.apply(block.tau, &block.clamp, &still(block.motion)).0;
            let (pose, reactions) = clamp.in_units(units);
            let (last, others) = block.contacts.split_last()?;
            let mut rest = Vector2::new(-reactions.f0x, -reactions.f0y);
            let mut loads = Vec::with_capacity(block.contacts.len());
            for Contact { s, force, alpha, .. } in others {
                rest -= Vector2::new(alpha.sin(), -alpha.cos()) * *force;
                loads.push(Load { s: *s, force: *force, alpha: *alpha });
            }
            loads.push(Load { s: last.s, force: rest.norm(), alpha: rest.x.atan2(-rest.y) });
            let base = rod.base(pose, &reactions);
            let bent = Elastica::of_rod(rod.model().clone(), units, base, reactions.m0z, &loads).ok()?;
            Some(bent.sample(POINTS).map(|at| Vector2::new(at.x, at.y) / units.length).collect())
        };
        Self { shapes: known.iter().step_by(known.len().div_ceil(SHAPES).max(1)).filter_map(shape).collect() }
    }

    /// Of states of the rod.
    pub fn of_states<'a, R: PhysicalRod>(rod: &R, states: impl Iterator<Item = &'a State>) -> Self {
        let length = rod.units().length;
        let states: Vec<&State> = states.collect();
        let shape = |state: &&State| {
            let bent = state.elastica(rod).ok()?;
            Some(bent.sample(POINTS).map(|at| Vector2::new(at.x, at.y) / length).collect())
        };
        Self { shapes: states.iter().step_by(states.len().div_ceil(SHAPES).max(1)).filter_map(shape).collect() }
    }

    /// With those of another.
    pub fn and(mut self, other: Self) -> Self {
        self.shapes.extend(other.shapes);
        self
    }

    /// Whether the rod was where a contour from one place to another would be, with the solid on its left.
    pub fn forbids(&self, from: Vector2<f64>, to: Vector2<f64>) -> bool {
        let Some(along) = (to - from).try_normalize(1e-12) else { return false };
        let inwards = Vector2::new(-along.y, along.x) * INSIDE;
        let (from, to) = (from + inwards, to + inwards);
        let crosses = |shape: &&Vec<Vector2<f64>>| shape.windows(2).any(|pair| cross(from, to, pair[0], pair[1]));
        self.shapes.iter().filter(crosses).take(OFTEN).count() == OFTEN
    }
}

/// Whether two line segments cross.
fn cross(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>, d: Vector2<f64>) -> bool {
    let side = |p: Vector2<f64>, q: Vector2<f64>, r: Vector2<f64>| (q - p).perp(&(r - p));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
