//! The shape of a rod by its unknowns, with exact derivatives: from its outermost contact back to the base, and on to the tip.

use rod_core::{Cut, RodModel};

/// Largest number of unknowns: a position and direction, and three numbers for each of two contacts.
pub(super) const MOST: usize = 9;

/// One contact as a set of unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// At the tip, the force in any direction: unknowns A, B.
    Tip,
    /// On the side: unknowns arc length, force across the rod, and force along it by friction. Of what is given, the arc length and the share of the
    /// force across that the one along is, nothing is unknown.
    Side { s: Option<f64>, rub: Option<f64> },
}

impl Place {
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Tip => 2,
            Self::Side { s, rub } => 1 + usize::from(s.is_none()) + usize::from(rub.is_none()),
        }
    }
}

/// Position and direction, then the contacts from the outermost inwards.
pub(super) fn unknowns(contacts: &[Place]) -> usize {
    3 + contacts.iter().map(Place::unknowns).sum::<usize>()
}

/// The rod at one arc length, with derivatives by all unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub s: f64,
    /// The unknown that the arc length is.
    pub s_unknown: Option<usize>,
    pub cut: Cut,
    /// (x, y, phi, moment) by each unknown, also where the arc length is one.
    pub by: [[f64; 4]; MOST],
}

/// The force (A, B) that a part of the rod carries, or a contact adds to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Force {
    pub ab: [f64; 2],
    pub by: [[f64; 2]; MOST],
}

impl Force {
    const NONE: Self = Self { ab: [0.0; 2], by: [[0.0; 2]; MOST] };

    fn add(&mut self, other: &Self) {
        self.ab = [self.ab[0] + other.ab[0], self.ab[1] + other.ab[1]];
        for (by, other) in self.by.iter_mut().zip(&other.by) {
            *by = [by[0] + other[0], by[1] + other[1]];
        }
    }
}

/// A contact of a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub node: Node,
    /// The force that it adds.
    pub force: Force,
    pub is_tip: bool,
}

/// A shape: its base, the force there, and its contacts from the outermost inwards.
#[derive(Clone)]
pub(super) struct Shape {
    pub base: Node,
    pub force: Force,
    pub contacts: Vec<Contact>,
}

/// Follows the rod with the unknowns `u`, and shows it at the `stations`, arc lengths that grow, each with its number; those behind the
/// outermost contact come first, then the others from there to the base. None where a contact is not on the rod.
pub(super) fn trace<M: RodModel>(
    model: &M,
    contacts: &[Place],
    u: &[f64],
    stations: &[f64],
    mut show: impl FnMut(usize, &Node),
) -> Option<Shape> {
    let count = u.len();
    let mut at = Node {
        s: 0.0,
        s_unknown: None,
        cut: Cut { x: u[0], y: u[1], phi: u[2], moment: 0.0 },
        by: std::array::from_fn(|k| std::array::from_fn(|i| f64::from(u8::from(k == i && k < 3)))),
    };
    let mut first = 3;
    let mut found = Vec::with_capacity(contacts.len());
    let mut force = Force::NONE;
    let mut left = stations.len();
    for (number, place) in contacts.iter().enumerate() {
        let (s, s_unknown) = match place {
            Place::Tip => (1.0, None),
            Place::Side { s: Some(s), .. } => (*s, None),
            Place::Side { s: None, .. } => (u[first], Some(first)),
        };
        let most = if number == 0 { 1.0 } else { at.s };
        if !(s > LEAST && s <= most) {
            return None;
        }
        if number == 0 {
            (at.s, at.s_unknown) = (s, s_unknown);
            left = stations.partition_point(|station| *station < s);
            let mut beyond = at;
            for (k, station) in stations.iter().enumerate().skip(left) {
                beyond = unloaded(model, &beyond, *station, count);
                show(k, &beyond);
            }
        } else {
            while left > 0 && stations[left - 1] >= s {
                left -= 1;
                at = carry(model, &at, &force, (stations[left], None), count);
                show(left, &at);
            }
            at = carry(model, &at, &force, (s, s_unknown), count);
        }
        let contact = add(place, &at, u, first);
        force.add(&contact.force);
        found.push(contact);
        first += place.unknowns();
    }
    if contacts.is_empty() {
        let base = at;
        for (k, station) in stations.iter().enumerate() {
            at = unloaded(model, &at, *station, count);
            show(k, &at);
        }
        return Some(Shape { base, force, contacts: found });
    }
    while left > 0 {
        left -= 1;
        at = carry(model, &at, &force, (stations[left], None), count);
        show(left, &at);
    }
    let base = carry(model, &at, &force, (0.0, None), count);
    Some(Shape { base, force, contacts: found })
}

/// Least arc length (L) of a contact: nearer to the base it does not bend the rod.
const LEAST: f64 = 1e-4;

/// The force of a contact whose unknowns begin at `first`.
fn add(place: &Place, node: &Node, u: &[f64], first: usize) -> Contact {
    let mut force = Force::NONE;
    let Place::Side { s, rub } = place else {
        force.ab = [u[first], u[first + 1]];
        force.by[first] = [1.0, 0.0];
        force.by[first + 1] = [0.0, 1.0];
        return Contact { node: *node, force, is_tip: true };
    };
    let size = first + usize::from(s.is_none());
    let (sin, cos) = node.cut.phi.sin_cos();
    let across = u[size];
    let along = rub.map_or_else(|| u[size + 1], |rub| rub * across);
    force.ab = [across * cos - along * sin, across * sin + along * cos];
    for (by, node) in force.by.iter_mut().zip(&node.by) {
        *by = [-force.ab[1] * node[2], force.ab[0] * node[2]];
    }
    let mut add = |k: usize, across: f64, along: f64| {
        let by: &mut [f64; 2] = &mut force.by[k];
        *by = [by[0] + across * cos - along * sin, by[1] + across * sin + along * cos];
    };
    add(size, 1.0, rub.unwrap_or(0.0));
    if rub.is_none() {
        add(size + 1, 0.0, 1.0);
    }
    Contact { node: *node, force, is_tip: false }
}

/// The rod at another arc length where neither force nor moment bends it, whatever the unknowns are.
fn unloaded<M: RodModel>(model: &M, from: &Node, to: f64, count: usize) -> Node {
    if !model.is_straight() {
        return carry(model, from, &Force::NONE, (to, None), count);
    }
    let (length, (sin, cos)) = (to - from.s, from.cut.phi.sin_cos());
    let mut node = Node { s: to, s_unknown: None, ..*from };
    node.cut.x += length * cos;
    node.cut.y += length * sin;
    for by in node.by.iter_mut().take(count) {
        by[0] -= length * sin * by[2];
        by[1] += length * cos * by[2];
    }
    if let Some(k) = from.s_unknown {
        node.by[k][0] -= cos;
        node.by[k][1] -= sin;
    }
    node
}

/// The rod at another arc length, which may be an unknown.
fn carry<M: RodModel>(
    model: &M,
    from: &Node,
    force: &Force,
    (to, s_unknown): (f64, Option<usize>),
    count: usize,
) -> Node {
    let (cut, d) = model.carry_with_sensitivities(from.s, &from.cut, force.ab[0], force.ab[1], to - from.s);
    let mut by = [[0.0; 4]; MOST];
    for ((by, from), [a, b]) in by.iter_mut().zip(&from.by).zip(&force.by).take(count) {
        let [x, y, phi, moment] = *from;
        *by = std::array::from_fn(|i| d.by_phi[i] * phi + d.by_moment[i] * moment + d.by_a[i] * a + d.by_b[i] * b);
        by[0] += x;
        by[1] += y;
    }
    for (unknown, rate) in [(from.s_unknown, &d.by_from), (s_unknown, &d.by_to)] {
        if let Some(k) = unknown {
            by[k].iter_mut().zip(rate).for_each(|(by, rate)| *by += rate);
        }
    }
    Node { s: to, s_unknown, cut, by }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{Cone, Smooth, Uniform};

    /// Derivatives at base and stations against differences, for all kinds of contacts.
    fn check<M: RodModel>(model: &M, contacts: &[Place], u: &[f64]) {
        let stations = [0.05, 0.3, 0.45, 0.66, 0.8, 1.0];
        let all = |u: &[f64]| {
            let mut nodes = vec![None; stations.len()];
            let shape = trace(model, contacts, u, &stations, |k, node| nodes[k] = Some(*node)).unwrap();
            nodes.into_iter().flatten().chain([shape.base]).collect::<Vec<_>>()
        };
        let exact = all(u);
        assert_eq!(exact.len(), stations.len() + 1);
        for k in 0..u.len() {
            let moved =
                |h: f64| all(&u.iter().enumerate().map(|(i, v)| v + if i == k { h } else { 0.0 }).collect::<Vec<_>>());
            let h = 1e-5;
            for ((one, other), exact) in moved(h).iter().zip(&moved(-h)).zip(&exact) {
                let of = |node: &Node| [node.cut.x, node.cut.y, node.cut.phi, node.cut.moment];
                for ((one, other), by) in of(one).into_iter().zip(of(other)).zip(exact.by[k]) {
                    let difference = (one - other) / (2.0 * h);
                    assert!((difference - by).abs() < 1e-7 * (1.0 + by.abs()), "{contacts:?} {k}: {difference} {by}");
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        const SIDE: Place = Place::Side { s: None, rub: Some(0.0) };
        let cone = Smooth::new(Cone { taper: 0.7 }).unwrap();
        let free = Place::Side { s: None, rub: None };
        for (contacts, u) in [
            (vec![], vec![0.1, 0.2, 0.3]),
            (vec![SIDE], vec![0.6, 0.2, 0.9, 0.7, 1.1]),
            (vec![free], vec![0.6, 0.2, 0.9, 0.7, 1.1, 0.2]),
            (vec![Place::Tip], vec![0.6, 0.2, 0.9, 0.4, -0.3]),
            (vec![Place::Tip, SIDE], vec![0.6, 0.2, 0.9, 0.4, -0.3, 0.5, 1.3]),
            (vec![free, free], vec![0.6, 0.2, 0.9, 0.9, 0.3, 0.1, 0.5, -1.3, -0.3]),
        ] {
            check(&Uniform, &contacts, &u);
            check(&cone, &contacts, &u);
        }
    }
}
