//! A contour without what no state touches: there nothing is known of it.

use super::curve::{Curve, Node};
use super::ends::{beyond, ways_beyond};
use super::forward::NEAR_VERTEX;
use super::swept::Swept;
use nalgebra::Vector2;
use rod_contact::State;

/// Longest way between two places that are touched along which a contour goes on, rod lengths.
const GAP: f64 = 0.05;

/// Which nodes of each chain the contacts of states lie between, or at.
pub(super) fn touched(chains: &[Vec<Node>], states: &[Option<State>], length: f64) -> Vec<Vec<bool>> {
    let mut flat = vec![false; chains.iter().map(Vec::len).sum()];
    let Some(curve) = Curve::through(chains) else {
        return chains.iter().map(|chain| vec![false; chain.len()]).collect();
    };
    for contact in states.iter().flatten().flat_map(|state| &state.contacts) {
        let nodes = curve.place(contact, NEAR_VERTEX * length).and_then(|contact| curve.nodes_around(&contact));
        if let Some(nodes) = nodes {
            flat[nodes].fill(true);
        }
    }
    let mut rest = flat.as_slice();
    let of = |chain: &Vec<Node>| {
        let (own, others) = rest.split_at(chain.len());
        rest = others;
        own.to_vec()
    };
    chains.iter().map(of).collect()
}

/// The parts of chains that are touched, each with ends, of so many rod lengths at most, that leave free where the rod was. None where nothing is touched.
pub(super) fn trimmed(
    chains: &[Vec<Node>],
    touched: &[Vec<bool>],
    swept: &Swept,
    length: f64,
    most: f64,
) -> Option<Vec<Vec<Node>>> {
    let parts: Vec<Vec<Node>> =
        chains.iter().zip(touched).flat_map(|(chain, touched)| parts(chain, touched, GAP * length)).collect();
    let places: Vec<Vec<_>> = parts.iter().map(|part| part.iter().map(|node| node.at / length).collect()).collect();
    let with_ends = |(part, ways): (&Vec<Node>, [f64; 2])| {
        let ways = ways.map(|way| way.min(most));
        let last = part.len() - 1;
        let end = |at: Vector2<f64>, along: Vector2<f64>, way: f64| {
            beyond(at / length, along.y.atan2(along.x), way, swept).into_iter().map(|node| node.scaled(length))
        };
        let before = end(part[0].at, part[1].at - part[0].at, -ways[0]).rev();
        let after = end(part[last].at, part[last].at - part[last - 1].at, ways[1]);
        before.chain(part.iter().copied()).chain(after).collect()
    };
    (!parts.is_empty()).then(|| parts.iter().zip(ways_beyond(&places)).map(with_ends).collect())
}

/// Runs of touched nodes, and of others between them where the way is short.
fn parts(chain: &[Node], touched: &[bool], gap: f64) -> Vec<Vec<Node>> {
    let mut parts: Vec<Vec<Node>> = Vec::new();
    let mut last: Option<usize> = None;
    for k in (0..chain.len()).filter(|k| touched[*k]) {
        match (last, parts.last_mut()) {
            (Some(last), Some(part)) if k == last + 1 || (chain[k].at - chain[last].at).norm() <= gap => {
                part.extend_from_slice(&chain[last + 1..=k]);
            }
            _ => parts.push(vec![chain[k]]),
        }
        last = Some(k);
    }
    parts.retain(|part| part.len() > 1);
    parts
}
