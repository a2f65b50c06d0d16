//! Contours that might explain what the contour so far does not.

use super::curve::Node;
use super::ends::arc;
use super::order::LONGEST;
use super::swept::Swept;
use nalgebra::{Rotation2, Vector2};
use rod_core::{Elastica, RodModel};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

/// Distance of the nodes of new contour, rod lengths, and how many there are to either side of a new contact.
const SPACING: f64 = 0.02;
const ARM: usize = 4;
/// Standard deviation of such a node, rod lengths.
pub(super) const NEW: f64 = 0.03;
/// Places along the rod at which a new contact is tried.
const PLACES: usize = 24;
/// Curvatures of the contour there, 1/L; infinite: a vertex.
const BENDS: [f64; 3] = [5.0, 40.0, f64::INFINITY];
/// The same where the tip touches, which may be in a hollow; and the angles between the rod and the contour there, radians.
pub(super) const TIP_BENDS: [f64; 5] = [0.0, 5.0, -5.0, -20.0, 40.0];
const TIP_TURNS: [f64; 7] = [0.15, 0.5, 1.0, FRAC_PI_2, 2.1, 2.6, 3.0];
/// Largest angle by which the contour turns from one of these nodes to the next, and from the vertex on (radians).
const TURN: f64 = 0.35;
const VERTEX_TURN: f64 = 0.8;
/// Shares of its length to which an arm is shortened until it leaves free where the rod was.
const SHORTER: [f64; 4] = [1.0, 0.5, 0.25, 0.1];
/// How far behind the rod new contour begins, rod lengths: contacts of a state leave no gap.
const BEHIND: f64 = 1e-5;
/// Most nodes on the way over which two parts are joined.
const MOST_BETWEEN: usize = 12;
/// Cosine of the angle between that way and the contour at its ends, at least.
const AHEAD: f64 = -0.2;
/// Longest way of a bend that may be a vertex, rod lengths, and its smallest turn, radians.
const SHARP_WITHIN: f64 = 0.05;
const SHARP_TURN: f64 = 0.3;
/// Angles from node to node by which an end may go on (radians), and how many.
const END_TURNS: [f64; 6] = [-0.2, -0.05, 0.0, 0.05, 0.2, 0.5];
const END: usize = 6;

/// Where new contour may be.
pub(super) struct Space<'a> {
    pub length: f64,
    pub swept: &'a Swept,
}

impl Space<'_> {
    /// New contours at places along a rod, on either side of it, and at its tip.
    pub fn on_rod<M: RodModel>(&self, rod: &Elastica<M>) -> Vec<Vec<Node>> {
        let mut found = Vec::new();
        for i in 1..PLACES {
            let at = rod.at(self.length * i as f64 / PLACES as f64);
            for (bend, alpha) in BENDS.into_iter().flat_map(|bend| [(bend, at.phi), (bend, at.phi + PI)]) {
                found.push(self.through(Vector2::new(at.x, at.y), alpha, bend));
            }
        }
        let tip = rod.at(self.length);
        for (bend, turn) in TIP_BENDS.into_iter().flat_map(|bend| TIP_TURNS.map(|turn| (bend, turn))) {
            found.push(self.through(Vector2::new(tip.x, tip.y), tip.phi - turn, bend));
        }
        found
    }

    /// Contour of about this curvature (1/L) through a place (m), with the solid on its left.
    pub fn through(&self, place: Vector2<f64>, alpha: f64, bend: f64) -> Vec<Node> {
        let at = place / self.length + Vector2::new(-alpha.sin(), alpha.cos()) * BEHIND;
        let is_vertex = bend.is_infinite();
        let long = if is_vertex { SPACING } else { SPACING.min(TURN / bend.abs().max(1.0)) };
        let arm = |sense: f64| {
            let shortened = |share: f64| {
                let turn = if is_vertex { 0.0 } else { sense * bend * long * share };
                let first = alpha + if is_vertex { sense * VERTEX_TURN } else { 0.5 * turn };
                arc(at, Vector2::new(first.cos(), first.sin()) * (sense * long * share), turn, ARM)
            };
            self.swept.first_free(at, SHORTER.map(shortened), sense > 0.0).into_iter().map(|at| Node::smooth(at, NEW))
        };
        let middle = Node { is_vertex, ..Node::smooth(at, NEW) };
        arm(-1.0).rev().chain([middle]).chain(arm(1.0)).map(|node| node.scaled(self.length)).collect()
    }
}

/// Contours of which two parts are one, the closest first. What is `touched` stays.
pub(super) fn joined(chains: &[Vec<Node>], touched: &[Vec<bool>], length: f64) -> Vec<Vec<Vec<Node>>> {
    let mut found: Vec<(f64, Vec<Vec<Node>>)> = Vec::new();
    for (i, (_, last)) in cores(touched) {
        for (j, (next, _)) in cores(touched).filter(|(j, _)| *j != i) {
            let (one, other) = (&chains[i][..=last], &chains[j][next..]);
            let Some(between) = between(one, other, length) else { continue };
            let whole = [one, &between, other].concat();
            let rest = (0..chains.len()).filter(|k| *k != i && *k != j).map(|k| chains[k].clone());
            found.push(((other[0].at - one[last].at).norm(), std::iter::once(whole).chain(rest).collect()));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, chains)| chains).collect()
}

/// Contours of which a bend is a vertex, the sharpest first: one that is touched, and turns enough within a short way.
pub(super) fn sharpened(chains: &[Vec<Node>], touched: &[Vec<bool>], length: f64) -> Vec<Vec<Vec<Node>>> {
    let mut found: Vec<(f64, Vec<Vec<Node>>)> = Vec::new();
    for (i, (chain, touched)) in chains.iter().zip(touched).enumerate() {
        for (sharpness, bend) in bends(chain, touched, length) {
            let [before, first, last, after] =
                [bend.start - 1, bend.start, bend.end - 1, bend.end].map(|k| chain[k].at);
            let Some(at) = crossing(first, first - before, last, after - last) else { continue };
            let vertex = Node { is_vertex: true, ..Node::smooth(at, NEW * length) };
            let mut chains = chains.to_vec();
            chains[i] = [&chain[..bend.start], &[vertex], &chain[bend.end..]].concat();
            found.push((sharpness, chains));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, chains)| chains).collect()
}

/// Contours with a part less, those first of which the least is touched.
pub(super) fn without_part(chains: &[Vec<Node>], touched: &[Vec<bool>]) -> Vec<Vec<Vec<Node>>> {
    if chains.len() < 2 {
        return Vec::new();
    }
    let count = |i: usize| touched[i].iter().filter(|is| **is).count();
    let mut parts: Vec<usize> = (0..chains.len()).collect();
    parts.sort_by_key(|i| count(*i));
    let without = |i| chains.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, chain)| chain.clone()).collect();
    parts.into_iter().map(without).collect()
}

/// Contours of which a vertex is a bend, or a straight way.
pub(super) fn dulled(chains: &[Vec<Node>]) -> Vec<Vec<Vec<Node>>> {
    let mut found = Vec::new();
    for (i, chain) in chains.iter().enumerate() {
        for k in (0..chain.len()).filter(|k| chain[*k].is_vertex) {
            let (mut bent, mut straight) = (chains.to_vec(), chains.to_vec());
            bent[i][k].is_vertex = false;
            straight[i].remove(k);
            found.extend([bent, straight]);
        }
    }
    found
}

/// Nodes of a chain that are touched and bend around the solid, and by how much they turn more than a gentle bend of their way: the sharpest ones
/// that have no node in common.
fn bends(chain: &[Node], touched: &[bool], length: f64) -> Vec<(f64, Range<usize>)> {
    let step = |k: usize| chain[k + 1].at - chain[k].at;
    let mut found: Vec<(f64, Range<usize>)> = Vec::new();
    for first in 1..chain.len().saturating_sub(2) {
        let (mut turn, mut way) = (turn_of(step(first - 1), step(first)), 0.0);
        for last in first + 1..chain.len() - 1 {
            let is_part = (first..=last).all(|k| touched[k] && !chain[k].is_vertex);
            (way, turn) = (way + step(last - 1).norm() / length, turn + turn_of(step(last - 1), step(last)));
            if !is_part || way > SHARP_WITHIN {
                break;
            }
            if turn > SHARP_TURN {
                found.push((turn - way * SHARP_TURN / SHARP_WITHIN, first..last + 1));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<(f64, Range<usize>)> = Vec::new();
    for one in found {
        if kept.iter().all(|other| one.1.end <= other.1.start || other.1.end <= one.1.start) {
            kept.push(one);
        }
    }
    kept
}

fn turn_of(from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    from.perp(&to).atan2(from.dot(&to))
}

/// Where a line from a place on meets another line on its way to a place; none where it does behind them.
fn crossing(from: Vector2<f64>, along: Vector2<f64>, to: Vector2<f64>, on: Vector2<f64>) -> Option<Vector2<f64>> {
    let sine = along.perp(&on);
    let (ahead, back) = ((to - from).perp(&on) / sine, (to - from).perp(&along) / sine);
    (ahead >= 0.0 && back <= 0.0 && ahead.is_finite()).then(|| from + along * ahead)
}

/// Contours of which an end goes on otherwise. What is `touched` stays.
pub(super) fn with_other_ends(chains: &[Vec<Node>], touched: &[Vec<bool>], length: f64) -> Vec<Vec<Vec<Node>>> {
    let mut found = Vec::new();
    for (i, (first, last)) in cores(touched) {
        let chain = &chains[i];
        for turn in END_TURNS {
            let end = |at: Vector2<f64>, from: Vector2<f64>, turn: f64| {
                onwards(at, (at - from).normalize() * (SPACING * length), turn, END, NEW * length)
            };
            let after = end(chain[last].at, chain[last - 1].at, turn);
            let mut before = end(chain[first].at, chain[first + 1].at, -turn);
            before.reverse();
            for changed in [[&chain[..=last], &after].concat(), [&before, &chain[first..]].concat()] {
                let mut chains = chains.to_vec();
                chains[i] = changed;
                found.push(chains);
            }
        }
    }
    found
}

/// So many nodes with which a contour goes on from a place, each a step from the one before that is turned by so much.
pub(super) fn onwards(at: Vector2<f64>, step: Vector2<f64>, turn: f64, count: usize, sigma: f64) -> Vec<Node> {
    let turned = Rotation2::new(turn) * step;
    arc(at, turned, turn, count).into_iter().map(|at| Node::smooth(at, sigma)).collect()
}

/// Nodes on a cubic from the end of one chain to the start of another; none where the way is long or turns back.
fn between(one: &[Node], other: &[Node], length: f64) -> Option<Vec<Node>> {
    let (from, to) = (one.last()?.at, other.first()?.at);
    let [along, on] = [from - one[one.len() - 2].at, other[1].at - to].map(|along| along.normalize());
    let way = (to - from).norm();
    let is_ahead = |along: &Vector2<f64>| (to - from).dot(along) >= AHEAD * way;
    if !(way > BEHIND * length && way <= LONGEST * length && is_ahead(&along) && is_ahead(&on)) {
        return None;
    }
    let count = ((way / (SPACING * length)).ceil() as usize).min(MOST_BETWEEN);
    let node = |k: usize| {
        let t = k as f64 / count as f64;
        let (u, v) = (t * t, t * t * t);
        let at = from * (2.0 * v - 3.0 * u + 1.0) + to * (3.0 * u - 2.0 * v);
        Node::smooth(at + (along * (v - 2.0 * u + t) + on * (v - u)) * way, NEW * length)
    };
    Some((1..count).map(node).collect())
}

/// The chains that are touched at two nodes or more, with the first and the last of these.
fn cores(touched: &[Vec<bool>]) -> impl Iterator<Item = (usize, (usize, usize))> {
    let ends = |of: &Vec<bool>| of.iter().position(|is| *is).zip(of.iter().rposition(|is| *is));
    let all = touched.iter().map(ends).enumerate();
    all.filter_map(|(k, ends)| Some((k, ends?))).filter(|(_, (first, last))| first < last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bend_between_two_straight_parts_becomes_the_vertex_where_they_meet() {
        // along x to (1, 0) and on at 45 degrees, with the corner rounded
        let (along, on) = (Vector2::new(0.02, 0.0), Vector2::new(0.0142, 0.0142));
        let corner = Vector2::new(1.0, 0.0);
        let before = (1..8).rev().map(|k| corner - along * f64::from(k));
        let rounded = [corner - along * 0.4, corner + Vector2::new(-0.0015, 0.002), corner + on * 0.4];
        let after = (1..8).map(|k| corner + on * f64::from(k));
        let chain: Vec<Node> = before.chain(rounded).chain(after).map(|at| Node::smooth(at, NEW)).collect();
        let touched = vec![vec![true; chain.len()]];
        let found = sharpened(std::slice::from_ref(&chain), &touched, 1.0);
        let vertex = found[0][0].iter().find(|node| node.is_vertex).unwrap();
        assert!((vertex.at - corner).norm() < 3e-3, "{vertex:?}");
        // what nothing touches stays a bend
        assert!(sharpened(std::slice::from_ref(&chain), &[vec![false; chain.len()]], 1.0).is_empty());
    }
}
