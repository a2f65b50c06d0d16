//! From contact points in order to a contour that a fit can start from.

use super::curve::{Curve, Node};
use super::ends::{GUESSED, beyond, way_beyond, ways_beyond};
use super::order::{
    LONGEST, NO_WAY, SHARPLY, SURE, Touched, cells, dearness, in_order, mean, merged, sure_enough, weight,
    without_doubles,
};
use super::swept::Swept;
use crate::numeric::wrap_angle;

/// Distance of the nodes of the start in standard deviations of the points, and the smallest and the largest one, rod lengths. Smaller: noise
/// comes into the order; larger: the start is coarser than what is known.
const PER_SIGMA: f64 = 100.0;
const SPACINGS: (f64, f64) = (0.008, 0.03);
/// Longest step between places that no contact has in common, spacings: the rod bridges, or jumps across, what is between them.
const APART: f64 = 2.0;
/// Chains whose places have less than this share of the weight of all are strays, unless the points are sure.
const STRAY: f64 = 1e-3;
/// Distance of a point from the middle of its neighbours over theirs from which on it is noise, and how often it is brought nearer.
const ZIGZAG: f64 = 0.15;
const SMOOTHINGS: usize = 3;
/// Gaps wider than so many spacings get points in them: a spline cannot bend between two of its points.
const WIDE: f64 = 1.5;
/// Radius (rod lengths) and angle (radians) of a bend that is a vertex: smaller, and larger.
const SHARP: f64 = 4e-3;
const VERTEX_TURN: f64 = 0.3;
/// Standard deviation of a node about its start, rod lengths, where the rod touched about there. Smaller: the start shows in the result; larger:
/// places that no state touches yet are drawn away by the smoothness of their neighbours.
const TOUCHED: f64 = 0.03;

/// What an outline takes its points for. Different ones lead to different contours, and the recording tells which of them is right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interpretation {
    /// The points are answers; others are as noise left them: then strays are left out and zigzags smoothed.
    pub is_sure: bool,
    /// Neighbouring traces are of one object; else the contour between them is not known.
    pub is_joined: bool,
    /// Places that noise alone might part, and that turn, are one vertex; else they are a bend.
    pub is_sharp: bool,
}

/// Chains of nodes along the contours, in their direction, with the solid on the left.
pub(super) fn outline(touched: &[Touched], reading: Interpretation, swept: &Swept) -> Vec<Vec<Node>> {
    let touched = sure_enough(touched, if reading.is_sharp { SHARPLY } else { SURE });
    // in order of their sigmas
    let Some(median) = touched.get(touched.len() / 2) else { return Vec::new() };
    let spacing = (PER_SIGMA * median.sigma).clamp(SPACINGS.0, SPACINGS.1);
    let mut chains =
        in_order(&cells(&touched, spacing), if reading.is_joined { LONGEST } else { APART * spacing }, |from, to| {
            (to - from).norm() > APART * spacing && swept.forbids(from, to)
        });
    without_doubles(&mut chains, spacing);
    if !reading.is_sure {
        let all: f64 = chains.iter().map(|chain| weight(chain)).sum();
        chains.retain(|chain| weight(chain) > STRAY * all);
    }
    let chains: Vec<Vec<Touched>> = chains.into_iter().map(|chain| merged(chain, spacing)).collect();
    let places: Vec<Vec<_>> = chains.iter().map(|chain| chain.iter().map(|place| place.at).collect()).collect();
    let ends = ways_beyond(&places);
    chains.into_iter().zip(ends).flat_map(|(chain, ends)| simple(chain, ends, spacing, reading, swept)).collect()
}

/// A chain as nodes, with its ends so far beyond; one that crosses itself is cut at its dearest step until no part does.
fn simple(
    mut chain: Vec<Touched>,
    ends: [f64; 2],
    spacing: f64,
    reading: Interpretation,
    swept: &Swept,
) -> Vec<Vec<Node>> {
    let nodes = nodes(&chain, ends, spacing, reading, swept);
    if Curve::through(std::slice::from_ref(&nodes)).and_then(|curve| curve.objects()).is_some() {
        return vec![nodes];
    }
    let dear = |k: &usize| dearness(&chain[*k - 1], &chain[*k]);
    let Some(cut) = (1..chain.len()).max_by(|a, b| dear(a).total_cmp(&dear(b))) else { return Vec::new() };
    let at_cut = way_beyond((chain[cut].at - chain[cut - 1].at).norm());
    let rest = chain.split_off(cut);
    [
        simple(chain, [ends[0], at_cut], spacing, reading, swept),
        simple(rest, [at_cut, ends[1]], spacing, reading, swept),
    ]
    .concat()
}

/// A chain of nodes through places, with its ends beyond them.
fn nodes(chain: &[Touched], ends: [f64; 2], spacing: f64, reading: Interpretation, swept: &Swept) -> Vec<Node> {
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else { return Vec::new() };
    let mut points = with_vertices(chain, reading.is_sharp);
    if !reading.is_sure {
        smooth(&mut points);
    }
    let mut nodes = beyond(first.at, first.alpha(), -ends[0], swept);
    nodes.reverse();
    nodes.extend(filled(&points, spacing));
    nodes.extend(beyond(last.at, last.alpha(), ends[1], swept));
    nodes
}

/// The places as nodes; those that turn within a small radius are one vertex.
fn with_vertices(chain: &[Touched], is_sharp: bool) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(chain.len());
    let mut k = 0;
    while k < chain.len() {
        let (mut end, mut turn) = (k, 0.0);
        while let Some(next) = chain.get(end + 1) {
            let (step, by) = (next.at - chain[end].at, wrap_angle(next.alpha() - chain[end].alpha()));
            // noise alone gives places an order against their directions
            let is_astray = step.dot(&chain[end].along).min(step.dot(&next.along)) < 0.0;
            let is_close = (next.at - chain[k].at).norm() < NO_WAY;
            let is_bend = by > 0.0 && (is_sharp && is_close || step.norm() < SHARP * by);
            if !(is_bend || is_astray && is_close) {
                break;
            }
            (end, turn) = (end + 1, turn + by);
        }
        let is_vertex = turn > VERTEX_TURN;
        nodes.push(Node { at: mean(&chain[k..=end]).at, is_vertex, sigma: TOUCHED });
        k = end + 1;
    }
    nodes
}

/// Each node but the ends at the mean of itself, twice, and its neighbours, where it leaves their line by more than a part of their distance: a
/// rod finds no equilibrium on a zigzag of noise.
fn smooth(nodes: &mut [Node]) {
    for _ in 0..SMOOTHINGS {
        let before = nodes.to_vec();
        for k in 1..nodes.len().saturating_sub(1) {
            let (a, b, c) = (before[k - 1].at, before[k].at, before[k + 1].at);
            let middle = 0.5 * (a + c);
            if !before[k].is_vertex && (b - middle).norm() > ZIGZAG * (c - a).norm() {
                nodes[k].at = 0.5 * (b + middle);
            }
        }
    }
}

/// With nodes between those of a wide gap, on the line that joins them.
fn filled(nodes: &[Node], spacing: f64) -> Vec<Node> {
    let mut filled = Vec::with_capacity(nodes.len());
    for pair in nodes.windows(2) {
        let step = pair[1].at - pair[0].at;
        let parts = (step.norm() / (WIDE * spacing)).ceil().max(1.0);
        filled.push(pair[0]);
        filled.extend(
            (1..parts as usize).map(|k| Node::smooth(pair[0].at + step * (k as f64 / parts), GUESSED.min(step.norm()))),
        );
    }
    filled.extend(nodes.last());
    filled
}

#[cfg(test)]
mod tests {
    use super::super::ends::STEPS;
    use super::*;
    use nalgebra::Vector2;

    #[test]
    fn both_sides_of_a_thin_plate_are_passed_in_order() {
        // from left to right below, and back above, at a thickness of a third of the spacing
        let side = |x: f64, y: f64, way: f64| Touched {
            at: Vector2::new(x, y),
            along: Vector2::new(way, 0.0),
            sigma: 1e-3,
            weight: 1.0,
            trace: 0,
            sample: 0,
        };
        let x = |k: usize| 0.005 * k as f64;
        let mut touched: Vec<Touched> = (0..100).map(|k| side(x(k), 0.0, 1.0)).collect();
        touched.extend((0..100).map(|k| side(x(k), 0.01, -1.0)));
        let reading = Interpretation { is_sure: true, is_joined: false, is_sharp: false };
        let chains = outline(&touched, reading, &Swept::default());
        let ordered: Vec<Vector2<f64>> = chains.concat().iter().map(|node| node.at).collect();
        let inner = &ordered[STEPS..ordered.len() - STEPS];
        assert!(inner.iter().map(|point| point.y).is_sorted(), "{inner:?}");
        let on = |y: f64| inner.iter().filter(|point| point.y == y).map(|point| point.x).collect::<Vec<_>>();
        assert!(on(0.0).is_sorted() && on(0.01).iter().rev().is_sorted(), "{inner:?}");
    }

    #[test]
    fn a_hollow_is_passed_in_the_direction_of_its_points() {
        // an arc of radius 0.2 that the rod touches from inside, with the solid on the left of its direction
        let place = |k: usize| {
            let (sin, cos) = (0.03 * k as f64).sin_cos();
            let (at, along) = (Vector2::new(0.2 * sin, 0.2 * cos), Vector2::new(cos, -sin));
            Touched { at, along, sigma: 1e-5, weight: 1.0, trace: 0, sample: 0 }
        };
        let touched: Vec<Touched> = (0..40).map(place).collect();
        let reading = Interpretation { is_sure: true, is_joined: false, is_sharp: false };
        let chains = outline(&touched, reading, &Swept::default());
        let [chain] = &chains[..] else { panic!("{} chains", chains.len()) };
        assert!(chain[STEPS..chain.len() - STEPS].iter().map(|node| node.at.x).is_sorted(), "{chain:?}");
    }
}
