//! Contours without the hollows that the rod bridges with several contacts where one on a straight part might do.
//!
//! While a contact passes fast along a straight part, a recording hardly tells it from two at the ends of a hollow.

use super::curve::{Curve, Node};
use crate::contour::corners;
use nalgebra::Vector2;
use rod_contact::{Contact, ContactKind, State};

/// Depth of a bend below which it is straight, rod lengths. Smaller: noise of the points stays a hollow; larger: what is round becomes a polygon.
const FLAT: f64 = 2e-3;

/// A place on a contour: its chain, and the node.
type Place = (usize, usize);

/// Two places, in the direction of the contour, between which the rod bridges a hollow; on different chains, that between two parts.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bridge {
    from: Place,
    to: Place,
}

/// The chains of a contour with straight parts in place of the hollows that its states bridge: of all of them, then of those of each run of
/// states alone.
pub(super) fn flattened(curve: &Curve, states: &[Option<State>], length: f64) -> Vec<Vec<Vec<Node>>> {
    let chains = curve.nodes_of_chains();
    let of_state = |state: &Option<State>| state.iter().flat_map(|state| bridges(curve, state)).collect();
    let by_state: Vec<Vec<Bridge>> = states.iter().map(of_state).collect();
    let runs: Vec<Vec<Bridge>> =
        by_state.split(Vec::is_empty).filter(|run| !run.is_empty()).map(<[_]>::concat).collect();
    let each = runs.iter().filter(|_| runs.len() > 1);
    let all = Some(runs.concat()).filter(|all| !all.is_empty());
    all.iter().chain(each).map(|bridges| without_hollows(chains.clone(), bridges.clone(), FLAT * length)).collect()
}

/// The hollows between neighbouring contacts of a state that are on the same side of the rod.
fn bridges(curve: &Curve, state: &State) -> Vec<Bridge> {
    let of_pair = |pair: &[Contact]| {
        let [one, other] = pair else { return None };
        let way = Vector2::new(other.x - one.x, other.y - one.y);
        let [a, b] = [one, other].map(|contact| way.dot(&Vector2::new(contact.alpha.cos(), contact.alpha.sin())));
        if a * b <= 0.0 || pair.iter().any(|contact| contact.kind == ContactKind::Tip) {
            return None;
        }
        let (first, second) = if a > 0.0 { (one, other) } else { (other, one) };
        let (from, to) =
            (curve.in_chain(curve.nodes_around(first)?.start)?, curve.in_chain(curve.nodes_around(second)?.end - 1)?);
        (from.0 != to.0 || from.1 < to.1).then_some(Bridge { from, to })
    };
    state.contacts.windows(2).filter_map(of_pair).collect()
}

/// Chains with straight parts in place of hollows, of which none is deeper than `flat`.
fn without_hollows(mut chains: Vec<Vec<Node>>, mut bridges: Vec<Bridge>, flat: f64) -> Vec<Vec<Node>> {
    while let Some(k) = bridges.iter().position(|bridge| bridge.from.0 != bridge.to.0) {
        let Bridge { from: (one, mut last), to: (other, mut next) } = bridges[k];
        // the same two parts may be bridged from different nodes
        for bridge in bridges.iter().filter(|bridge| (bridge.from.0, bridge.to.0) == (one, other)) {
            (last, next) = (last.min(bridge.from.1), next.max(bridge.to.1));
        }
        let rest = std::mem::take(&mut chains[other]).split_off(next);
        chains[one].truncate(last + 1);
        chains[one].extend(rest);
        let joined = |(chain, node): Place| match chain {
            _ if chain == one => (one, node.min(last)),
            _ if chain == other => (one, node.max(next) - next + last + 1),
            _ => (chain, node),
        };
        for bridge in &mut bridges {
            *bridge = Bridge { from: joined(bridge.from), to: joined(bridge.to) };
        }
        bridges.retain(|bridge| bridge.from.0 != bridge.to.0 || bridge.from.1 < bridge.to.1);
    }
    for (object, chain) in chains.iter_mut().enumerate() {
        let of_chain = bridges.iter().filter(|bridge| bridge.from.0 == object);
        for (from, to) in merged(of_chain.map(|bridge| (bridge.from.1, bridge.to.1)).collect()).into_iter().rev() {
            let straight = straight(&chain[from..=to], flat);
            chain.splice(from..=to, straight);
        }
    }
    chains
}

/// Ranges in order, those that meet as one.
fn merged(mut ranges: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    ranges.sort_unstable();
    let mut merged: Vec<(usize, usize)> = Vec::new();
    for range in ranges {
        match merged.last_mut().filter(|last| range.0 <= last.1) {
            Some(last) => last.1 = last.1.max(range.1),
            None => merged.push(range),
        }
    }
    merged
}

/// Vertices in place of some nodes: their ends, and the corners of their hull that are deeper than `flat`.
fn straight(nodes: &[Node], flat: f64) -> Vec<Node> {
    let mut hull: Vec<Node> = Vec::new();
    for node in nodes {
        while let [.., a, b] = hull[..]
            && (b.at - a.at).perp(&(node.at - b.at)) <= 0.0
        {
            hull.pop();
        }
        hull.push(Node { is_vertex: true, ..*node });
    }
    let is_corner = corners(hull.len(), |k| hull[k].at.into(), |_| flat);
    hull.into_iter().zip(is_corner).filter_map(|(node, is_corner)| is_corner.then_some(node)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(places: &[(f64, f64)]) -> Vec<Node> {
        places.iter().map(|(x, y)| Node::smooth(Vector2::new(*x, *y), 1e-3)).collect()
    }

    fn places(chain: &[Node]) -> Vec<(f64, f64, bool)> {
        chain.iter().map(|node| (node.at.x, node.at.y, node.is_vertex)).collect()
    }

    #[test]
    fn a_hollow_between_two_corners_becomes_straight() {
        // the solid is above, on the left of the way
        let hollow = chain(&[(0.0, 0.1), (0.1, 0.0), (0.2, 0.01), (0.3, 0.02), (0.4, 0.0), (0.5, 0.1)]);
        let found = without_hollows(vec![hollow], vec![Bridge { from: (0, 1), to: (0, 4) }], 1e-3);
        let corners = [(0.0, 0.1, false), (0.1, 0.0, true), (0.4, 0.0, true), (0.5, 0.1, false)];
        assert_eq!(places(&found[0]), corners);
    }

    #[test]
    fn a_corner_between_two_hollows_stays() {
        let hollows = chain(&[(0.0, 0.0), (0.1, -0.01), (0.2, -0.05), (0.3, -0.01), (0.4, 0.0)]);
        let bridges = vec![Bridge { from: (0, 0), to: (0, 2) }, Bridge { from: (0, 2), to: (0, 4) }];
        let found = without_hollows(vec![hollows], bridges, 1e-3);
        assert_eq!(places(&found[0]), [(0.0, 0.0, true), (0.2, -0.05, true), (0.4, 0.0, true)]);
    }

    #[test]
    fn parts_between_which_the_rod_bridges_become_one() {
        let (left, right) =
            (chain(&[(0.0, 0.0), (0.1, 0.0), (0.15, 0.1)]), chain(&[(0.35, 0.1), (0.4, 0.0), (0.5, 0.0)]));
        let bridges = vec![Bridge { from: (0, 1), to: (1, 1) }, Bridge { from: (0, 1), to: (1, 2) }];
        let found = without_hollows(vec![left, right], bridges, 1e-3);
        assert_eq!(places(&found[0]), [(0.0, 0.0, false), (0.1, 0.0, true), (0.5, 0.0, true)]);
        assert!(found[1].is_empty());
    }
}
