//! How a contour goes on beyond what is known of it.

use super::curve::Node;
use super::swept::Swept;
use nalgebra::{Rotation2, Vector2};

/// A contour goes on beyond its first and last contact, by so much (rod lengths), but by no more than this share of the way to another chain.
const BEYOND: f64 = 0.12;
const TO_OTHERS: f64 = 0.4;
/// It turns there towards its solid, out of the way of the rod: by so much in all (radians) where it goes on that far, and where another chain
/// ends it before; in so many steps.
const CURLS: (f64, f64) = (0.4, 0.8);
pub(super) const STEPS: usize = 4;
/// By so much more (radians), and over such a share of that way, where the rod was in its way.
const MORE_CURLED: [(f64, f64); 6] = [(0.0, 1.0), (0.4, 1.0), (0.8, 1.0), (1.2, 0.6), (1.6, 0.4), (1.6, 0.2)];
/// Standard deviation of a node that is a guess, rod lengths; and over the way, where another chain ends it.
pub(super) const GUESSED: f64 = 0.3;
const OFF: f64 = 0.3;

/// Places one step apart, the first a step from `at`; each step is turned by so much from the one before.
pub(super) fn arc(mut at: Vector2<f64>, mut step: Vector2<f64>, turn: f64, count: usize) -> Vec<Vector2<f64>> {
    let turned = Rotation2::new(turn);
    let next = |_| {
        at += step;
        step = turned * step;
        at
    };
    (0..count).map(next).collect()
}

/// How far a contour goes on where the next chain is so far away, rod lengths.
pub(super) fn way_beyond(apart: f64) -> f64 {
    BEYOND.min(TO_OTHERS * apart)
}

/// The same for both ends of each chain of places.
pub(super) fn ways_beyond(chains: &[Vec<Vector2<f64>>]) -> Vec<[f64; 2]> {
    let apart = |k: usize, at: Option<&Vector2<f64>>| {
        let others = chains.iter().enumerate().filter(|other| other.0 != k).flat_map(|other| other.1);
        at.map_or(0.0, |at| others.map(|other| (other - at).norm()).fold(f64::INFINITY, f64::min))
    };
    let ends =
        |(k, chain): (usize, &Vec<Vector2<f64>>)| [chain.first(), chain.last()].map(|at| way_beyond(apart(k, at)));
    chains.iter().enumerate().map(ends).collect()
}

/// Nodes with which a contour goes on from a place in a direction, `way` rod lengths forwards, or backwards where that is negative: in as wide a
/// bend as leaves free where the rod was.
pub(super) fn beyond(from: Vector2<f64>, alpha: f64, way: f64, swept: &Swept) -> Vec<Node> {
    let is_cut = way.abs() < BEYOND;
    let (curl, sigma) = if is_cut { (CURLS.1, OFF * way.abs()) } else { (CURLS.0, GUESSED) };
    let bent = |(more, less): (f64, f64)| {
        let turn = way.signum() * (curl + more) / STEPS as f64;
        let (sin, cos) = (alpha + 0.5 * turn).sin_cos();
        arc(from, Vector2::new(cos, sin) * (less * way / STEPS as f64), turn, STEPS)
    };
    let places = swept.first_free(from, MORE_CURLED.map(bent), way > 0.0);
    places.into_iter().map(|at| Node::smooth(at, sigma)).collect()
}
