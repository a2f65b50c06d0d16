//! Where the rod was, no object is.

use super::bent::{bent, push, whole};
use super::blocks::{Block, Blocks};
use crate::systematic::Errors;
use nalgebra::Vector2;
use rod_contact::State;
use rod_core::{Elastica, PhysicalRod, RodModel};

/// Shapes of the rod that are looked at, and points of each. More: more time.
const SHAPES: usize = 200;
const POINTS: usize = 32;
/// Points of each shape where the rod bounds a contour: its chords are 1e-5 rod lengths off.
const FINE: usize = 200;
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
    pub fn of<R: PhysicalRod>(rod: &R, blocks: &Blocks, errors: &[Errors]) -> Self {
        let Some(corrections) = blocks.corrections(errors) else { return Self::default() };
        let units = rod.units();
        let known: Vec<_> = blocks.blocks.iter().filter(|block| !block.contacts.is_empty()).collect();
        let shape = |block: &&Block| {
            let (pose, reactions) = block.corrected(&block.clamp, &corrections[block.recording]).in_units(units);
            let (last, others) = block.contacts.split_last()?;
            let mut forces: Vec<_> =
                others.iter().map(|contact| (contact.s, push(contact.alpha) * contact.force)).collect();
            // what the others leave, whatever noise did to it
            let rest = forces.iter().fold(whole(&reactions), |rest, (_, force)| rest - force);
            forces.push((last.s, rest));
            Some(places(&bent(rod, pose, &reactions, &forces)?, POINTS))
        };
        Self { shapes: known.iter().step_by(known.len().div_ceil(SHAPES).max(1)).filter_map(shape).collect() }
    }

    /// Of states of the rod.
    pub fn of_states<'a, R: PhysicalRod>(rod: &R, states: impl Iterator<Item = &'a State>) -> Self {
        let states: Vec<&State> = states.collect();
        let shape = |state: &&State| Some(places(&state.elastica(rod).ok()?, POINTS));
        Self { shapes: states.iter().step_by(states.len().div_ceil(SHAPES).max(1)).filter_map(shape).collect() }
    }

    /// All of these shapes, finely.
    pub fn finely<M: RodModel>(shapes: impl Iterator<Item = Elastica<M>>) -> Self {
        Self { shapes: shapes.map(|shape| places(&shape, FINE)).collect() }
    }

    /// With those of another.
    pub fn and(mut self, other: Self) -> Self {
        self.shapes.extend(other.shapes);
        self
    }

    /// The first of some ways on from a place, rod lengths, that a contour can go because the rod was not there; else the last. Backwards the contour
    /// comes from there.
    pub fn first_free<const N: usize>(
        &self,
        from: Vector2<f64>,
        mut ways: [Vec<Vector2<f64>>; N],
        is_forwards: bool,
    ) -> Vec<Vector2<f64>> {
        let is_free = |way: &Vec<Vector2<f64>>| {
            let mut steps = std::iter::once(&from).chain(way).zip(way);
            steps.all(|(a, b)| if is_forwards { !self.forbids(*a, *b) } else { !self.forbids(*b, *a) })
        };
        let chosen = ways.iter().position(is_free).unwrap_or(N - 1);
        std::mem::take(&mut ways[chosen])
    }

    /// Whether the rod was where a contour from one place to another would be, with the solid on its left.
    pub fn forbids(&self, from: Vector2<f64>, to: Vector2<f64>) -> bool {
        let Some(along) = (to - from).try_normalize(1e-12) else { return false };
        let inwards = Vector2::new(-along.y, along.x) * INSIDE;
        let (from, to) = (from + inwards, to + inwards);
        let crosses = |shape: &&Vec<Vector2<f64>>| shape.windows(2).any(|pair| cross(from, to, pair[0], pair[1]));
        self.shapes.iter().filter(crosses).take(OFTEN).count() == OFTEN
    }

    /// The share of a way from a place after which it first meets the rod; none if it does not.
    pub fn first_on_ray(&self, from: Vector2<f64>, way: Vector2<f64>) -> Option<f64> {
        let steps = self.shapes.iter().flat_map(|shape| shape.windows(2));
        steps.filter_map(|pair| meets(from, way, pair[0], pair[1])).min_by(f64::total_cmp)
    }
}

/// The share of a way from a place after which it meets a line segment.
fn meets(from: Vector2<f64>, way: Vector2<f64>, a: Vector2<f64>, b: Vector2<f64>) -> Option<f64> {
    let (chord, apart) = (b - a, a - from);
    let sine = way.perp(&chord);
    let (share, on_chord) = (apart.perp(&chord) / sine, apart.perp(&way) / sine);
    ((0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&on_chord)).then_some(share)
}

/// So many points of a rod, rod lengths.
fn places<M: RodModel>(bent: &Elastica<M>, points: usize) -> Vec<Vector2<f64>> {
    bent.sample(points).map(|at| Vector2::new(at.x, at.y) / bent.length()).collect()
}

/// Whether two line segments cross.
fn cross(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>, d: Vector2<f64>) -> bool {
    let side = |p: Vector2<f64>, q: Vector2<f64>, r: Vector2<f64>| (q - p).perp(&(r - p));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
