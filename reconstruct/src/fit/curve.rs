//! The contour of a fit: smooth pieces that meet at vertices, and whose points move.

use super::piece::Piece;
use crate::numeric::wrap_angle;
use nalgebra::{DMatrix, DVector, Vector2};
use rod_contact::{Contact, ContactKind};
use rod_contours::{Composite, Contour as _, Frame};
use rod_core::SupportRate;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Share of the largest rate of a change of curvature below which a rate is left out: they fall to a fourth from knot to knot.
const FAR: f64 = 1e-6;

/// What an angle of one radian between a contact and the contour adds to their distance, as a share of it: two sides of a thin object are near.
const OTHER_SIDE: f64 = 3.0;

/// A point of a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub at: Vector2<f64>,
    /// Whether its pieces meet at an angle there.
    pub is_vertex: bool,
    /// How far it may be off, as a standard deviation.
    pub sigma: f64,
}

impl Node {
    pub fn smooth(at: Vector2<f64>, sigma: f64) -> Self {
        Self { at, is_vertex: false, sigma }
    }

    /// In another unit of length.
    pub fn scaled(self, unit: f64) -> Self {
        Self { at: self.at * unit, sigma: self.sigma * unit, ..self }
    }
}

/// Objects, each a chain of nodes with the solid on its left. The unknowns are the distances by which nodes lie off those of the start: along
/// the normal, of a vertex along x and y.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Nodes of the start, chain after chain.
    nodes: Vec<Node>,
    chains: Vec<Range<usize>>,
    /// The directions in which each node moves, and the number of its first unknown.
    ways: Vec<(Vec<Vector2<f64>>, usize)>,
    pub offsets: DVector<f64>,
    /// Where the nodes are.
    points: Vec<Vector2<f64>>,
    pieces: Vec<Piece>,
}

/// A value that depends on some of the unknowns, and its derivatives by these.
pub(super) type Dependent = (f64, Vec<(usize, f64)>);

impl Curve {
    /// Through chains of nodes, in the direction of contours; none where one of them gives no curve.
    pub fn through(chains: &[Vec<Node>]) -> Option<Self> {
        let mut nodes: Vec<Node> = Vec::new();
        let (mut ranges, mut ways, mut unknowns) = (Vec::new(), Vec::new(), 0);
        for chain in chains.iter().filter(|chain| chain.len() > 1) {
            let last = chain.len() - 1;
            for (i, node) in chain.iter().enumerate() {
                let is_vertex = node.is_vertex && i > 0 && i < last;
                let along = chain[(i + 1).min(last)].at - chain[i.saturating_sub(1)].at;
                let normal = Vector2::new(-along.y, along.x).normalize();
                let own = if is_vertex { vec![Vector2::x(), Vector2::y()] } else { vec![normal] };
                unknowns += own.len();
                ways.push((own, unknowns - 1 - usize::from(is_vertex)));
                nodes.push(Node { is_vertex, ..*node });
            }
            ranges.push(nodes.len() - chain.len()..nodes.len());
        }
        let points = nodes.iter().map(|node| node.at).collect();
        let offsets = DVector::zeros(unknowns);
        let curve = Self { nodes, chains: ranges, ways, offsets, points, pieces: Vec::new() };
        if curve.nodes.is_empty() { None } else { curve.with_pieces() }
    }

    fn with_pieces(mut self) -> Option<Self> {
        for (object, chain) in self.chains.iter().enumerate() {
            let (mut first, mut number) = (chain.start, 0);
            for k in chain.start + 1..chain.end {
                if self.nodes[k].is_vertex || k + 1 == chain.end {
                    self.pieces.push(Piece::through(&self.points[first..=k], first, object, number).ok()?);
                    (first, number) = (k, number + 1);
                }
            }
        }
        Some(self)
    }

    /// With other offsets of its nodes.
    pub fn moved(&self, offsets: DVector<f64>) -> Option<Self> {
        if offsets == self.offsets {
            return Some(self.clone());
        }
        let point = |(node, (own, first)): (&Node, &(Vec<Vector2<f64>>, usize))| {
            own.iter().enumerate().fold(node.at, |at, (i, way)| at + way * offsets[first + i])
        };
        let points = self.nodes.iter().zip(&self.ways).map(point).collect();
        let (nodes, chains, ways) = (self.nodes.clone(), self.chains.clone(), self.ways.clone());
        Self { nodes, chains, ways, offsets, points, pieces: Vec::new() }.with_pieces()
    }

    /// Number of unknowns.
    pub fn count(&self) -> usize {
        self.offsets.len()
    }

    /// The same contour with another node in the interval after each node of `cut`, at this share of it, and with vertices at the nodes of `sharp`.
    pub fn refined(&self, cut: &BTreeMap<usize, f64>, sharp: &BTreeSet<usize>) -> Option<Self> {
        let mut chains: Vec<Vec<Node>> = Vec::new();
        for (object, chain) in self.chains.iter().enumerate() {
            let mut nodes = Vec::new();
            for piece in self.pieces.iter().filter(|piece| piece.object == object) {
                for (i, knots) in piece.knots().windows(2).enumerate() {
                    let k = piece.first + i;
                    let node = self.nodes[k];
                    nodes.push(Node { at: self.points[k], is_vertex: node.is_vertex || sharp.contains(&k), ..node });
                    if let Some(share) = cut.get(&k) {
                        let frame = piece.spline.frame(knots[0] + (knots[1] - knots[0]) * share);
                        let sigma = node.sigma.max(self.nodes[k + 1].sigma);
                        nodes.push(Node::smooth(Vector2::new(frame.x, frame.y), sigma));
                    }
                }
            }
            nodes.push(Node { at: self.points[chain.end - 1], ..self.nodes[chain.end - 1] });
            chains.push(nodes);
        }
        Self::through(&chains)
    }

    pub fn objects(&self) -> Option<Vec<Composite>> {
        let pieces_of = |object: usize| self.pieces.iter().filter(move |piece| piece.object == object);
        let pieces = |object: usize| pieces_of(object).map(Piece::contour).collect::<Result<_, _>>();
        let whole = |object: usize| Composite::new(pieces(object)?);
        (0..self.chains.len()).map(whole).collect::<Result<_, _>>().ok()
    }

    /// The nodes of each object: where they are, and whether they are vertices.
    pub fn chains(&self) -> impl Iterator<Item = impl Iterator<Item = (usize, Node)>> {
        self.chains.iter().map(|chain| chain.clone().map(|k| (k, Node { at: self.points[k], ..self.nodes[k] })))
    }

    /// The nodes of each object where they are.
    pub fn nodes_of_chains(&self) -> Vec<Vec<Node>> {
        self.chains().map(|chain| chain.map(|(_, node)| node).collect()).collect()
    }

    /// The chain of a node, and its number there.
    pub fn in_chain(&self, node: usize) -> Option<(usize, usize)> {
        let chain = self.chains.iter().position(|chain| chain.contains(&node))?;
        Some((chain, node - self.chains[chain].start))
    }

    /// The directions in which a node moves, and the number of its first unknown.
    pub fn ways_of(&self, node: usize) -> (&[Vector2<f64>], usize) {
        let (ways, first) = &self.ways[node];
        (ways, *first)
    }

    /// How far each unknown may be off 0, as a standard deviation.
    pub fn sigmas(&self) -> impl Iterator<Item = f64> {
        self.nodes.iter().zip(&self.ways).flat_map(|(node, (own, _))| own.iter().map(|_| node.sigma))
    }

    /// Variance of a node across the contour, or of a vertex in its worst direction, of this covariance of the unknowns.
    pub fn variance(&self, node: usize, covariance: &DMatrix<f64>) -> f64 {
        let (own, first) = &self.ways[node];
        match own.len() {
            1 => covariance[(*first, *first)],
            _ => {
                let (a, b, c) =
                    (covariance[(*first, *first)], covariance[(first + 1, first + 1)], covariance[(*first, first + 1)]);
                0.5 * (a + b) + (0.25 * (a - b).powi(2) + c * c).sqrt()
            }
        }
    }

    /// The piece closest to a contact that has about its direction, and the parameter there.
    fn nearest(&self, contact: &Contact) -> Option<(&Piece, f64)> {
        let places = self.pieces.iter().map(|piece| (piece, piece.closest(contact.x, contact.y)));
        let distance = |closest: &rod_contours::Closest| {
            let Frame { x, y, alpha, .. } = closest.frame;
            (x - contact.x).hypot(y - contact.y) * (1.0 + OTHER_SIDE * wrap_angle(alpha - contact.alpha).abs())
        };
        places.min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1))).map(|(piece, closest)| (piece, closest.t))
    }

    /// A contact of about there on this contour: at a vertex near by, where the rod has a direction between those of its pieces.
    pub fn place(&self, contact: &Contact, near: f64) -> Option<Contact> {
        let vertex = (contact.kind != ContactKind::Tip).then(|| self.vertex_near(contact, near)).flatten();
        if let Some(piece) = vertex {
            let at = piece.points()[piece.points().len() - 1];
            let kind = ContactKind::Corner;
            return Some(Contact { object: piece.object, piece: piece.number, kind, x: at.x, y: at.y, ..*contact });
        }
        let (piece, t) = self.nearest(contact)?;
        let Frame { x, y, alpha, .. } = piece.spline.frame(t);
        let kind = if contact.kind == ContactKind::Tip { ContactKind::Tip } else { ContactKind::Tangent };
        Some(Contact { object: piece.object, piece: piece.number, kind, x, y, alpha, ..*contact })
    }

    /// The piece before the nearest vertex on which a rod of the direction of a contact can lie.
    fn vertex_near(&self, contact: &Contact, near: f64) -> Option<&Piece> {
        let distance = |at: &Vector2<f64>| (at.x - contact.x).hypot(at.y - contact.y);
        let pairs = self.pieces.windows(2).filter(|pair| {
            let (before, after) = (pair[0].end(), pair[1].start());
            let turn = wrap_angle(after.alpha - before.alpha);
            let at = wrap_angle(contact.alpha - before.alpha);
            pair[0].object == pair[1].object && 0.0 <= at && at <= turn && distance(&pair[1].points()[0]) < near
        });
        pairs.min_by(|a, b| distance(&a[1].points()[0]).total_cmp(&distance(&b[1].points()[0]))).map(|pair| &pair[0])
    }

    /// The node at which the interval of a contact of a state begins, and the share of it at which the contact is; none for a contact at a vertex.
    pub fn interval(&self, contact: &Contact) -> Option<(usize, f64)> {
        let (piece, t) = self.along(contact).filter(|_| !is_at_vertex(contact))?;
        let (piece, knots) = (&self.pieces[piece], self.pieces[piece].knots());
        let i = knots.partition_point(|knot| *knot <= t).clamp(1, knots.len() - 1) - 1;
        Some((piece.first + i, (t - knots[i]) / (knots[i + 1] - knots[i])))
    }

    /// The node next to which a contact of a state lies.
    pub fn node_at(&self, contact: &Contact) -> Option<usize> {
        match self.interval(contact) {
            Some((first, share)) => Some(if share < 0.5 { first } else { first + 1 }),
            None => self.vertex_of(contact),
        }
    }

    /// Way from a node to the nearer of its neighbours.
    pub fn spacing(&self, node: usize) -> f64 {
        let is_neighbour = |other: &usize| self.in_chain(node).map(|at| at.0) == self.in_chain(*other).map(|at| at.0);
        let neighbours = [node.checked_sub(1), Some(node + 1)].into_iter().flatten().filter(is_neighbour);
        neighbours.map(|other| (self.points[other] - self.points[node]).norm()).fold(f64::INFINITY, f64::min)
    }

    /// The nodes between which a contact of a state lies, or those around its vertex.
    pub fn nodes_around(&self, contact: &Contact) -> Option<Range<usize>> {
        if let Some((first, _)) = self.interval(contact) {
            return Some(first..first + 2);
        }
        let vertex = self.vertex_of(contact)?;
        Some(vertex - 1..(vertex + 2).min(self.nodes.len()))
    }

    /// The node at the end of the piece of a contact.
    fn vertex_of(&self, contact: &Contact) -> Option<usize> {
        let piece = &self.pieces[self.along(contact)?.0];
        Some(piece.first + piece.knots().len() - 1)
    }

    /// The number of the piece of a contact of a state, and the parameter there; at a vertex the end of the piece.
    fn along(&self, contact: &Contact) -> Option<(usize, f64)> {
        let is_its = |one: &Piece| one.object == contact.object && one.number == contact.piece;
        let k = self.pieces.iter().position(is_its)?;
        let end = self.pieces[k].knots()[self.pieces[k].knots().len() - 1];
        Some((k, if is_at_vertex(contact) { end } else { self.pieces[k].closest(contact.x, contact.y).t }))
    }

    /// How point and tangent of the contour at a contact of a state change with the unknowns.
    pub fn rates(&self, contact: &Contact) -> Vec<(usize, SupportRate)> {
        let Some((piece, t)) = self.along(contact) else { return Vec::new() };
        let piece = &self.pieces[piece];
        if is_at_vertex(contact) {
            let (own, first) = &self.ways[piece.first + piece.knots().len() - 1];
            let rate = |(i, way): (usize, &Vector2<f64>)| (first + i, SupportRate { x: way.x, y: way.y, alpha: 0.0 });
            return own.iter().enumerate().map(rate).collect();
        }
        self.rates_at(piece, t)
    }

    /// The same at the parameter `t` of a piece.
    fn rates_at(&self, piece: &Piece, t: f64) -> Vec<(usize, SupportRate)> {
        let tangent = piece.derivatives(t).0;
        let speed = tangent.norm();
        let mut rates = Vec::new();
        for at in piece.cardinals(t) {
            let (own, first) = &self.ways[at.node];
            rates.extend(own.iter().enumerate().map(|(i, way)| {
                let across = (tangent.x * way.y - tangent.y * way.x) / speed;
                let alpha = across * at.first / speed;
                (first + i, SupportRate { x: way.x * at.value, y: way.y * at.value, alpha })
            }));
        }
        rates
    }

    /// How deep the contour is behind the chord between two contacts on one object, at some places of the way; none on different ones.
    pub fn hollow(&self, one: &Contact, other: &Contact) -> Option<Vec<Dependent>> {
        if one.object != other.object {
            return None;
        }
        let [mut from, mut to] = [self.along(one)?, self.along(other)?];
        if (to.0, to.1) < (from.0, from.1) {
            (from, to) = (to, from);
        }
        let at = |(k, t): (usize, f64)| {
            let frame = self.pieces[k].spline.frame(t);
            (Vector2::new(frame.x, frame.y), self.rates_at(&self.pieces[k], t))
        };
        let ((start, of_start), (end, of_end)) = (at(from), at(to));
        let way = end - start;
        let along = way.try_normalize(1e-12)?;
        // the solid is on the left
        let inwards = Vector2::new(-along.y, along.x);
        let depth = |place: (usize, f64)| {
            let (point, of_point) = at(place);
            let share = ((point - start).dot(&along) / way.norm()).clamp(0.0, 1.0);
            let scaled = |rates: &[(usize, SupportRate)], factor: f64| {
                let rate = |(i, rate): &(usize, SupportRate)| (*i, factor * (inwards.x * rate.x + inwards.y * rate.y));
                rates.iter().map(rate).collect::<Vec<_>>()
            };
            let rates = [scaled(&of_point, 1.0), scaled(&of_start, share - 1.0), scaled(&of_end, -share)].concat();
            ((point - start).dot(&inwards), rates)
        };
        let places = (from.0..=to.0).flat_map(|k| {
            let knots = self.pieces[k].knots();
            let [first, last] = [(from, knots[0]), (to, knots[knots.len() - 1])]
                .map(|(end, of_piece)| if end.0 == k { end.1 } else { of_piece });
            let inner = knots.iter().copied().filter(move |t| *t > first && *t < last);
            let ends: Vec<f64> = std::iter::once(first).chain(inner).chain([last]).collect();
            // on the contacts themselves it is 0
            let at_ends = ends.iter().copied().skip(usize::from(k == from.0)).filter(move |t| k != to.0 || *t < last);
            ends.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).chain(at_ends).map(|t| (k, t)).collect::<Vec<_>>()
        });
        Some(places.map(depth).collect())
    }

    /// Change of the curvature from each node of a piece to the next over the root of their distance.
    pub fn bends(&self) -> Vec<Dependent> {
        let mut bends = Vec::new();
        for piece in &self.pieces {
            let at: Vec<Dependent> = piece.knots().iter().map(|t| self.curvature(piece, *t)).collect();
            for (pair, knots) in at.windows(2).zip(piece.knots().windows(2)) {
                let root = (knots[1] - knots[0]).sqrt();
                let mut rates: Vec<_> =
                    pair[0].1.iter().zip(&pair[1].1).map(|(a, b)| (a.0, (b.1 - a.1) / root)).collect();
                let most = rates.iter().map(|(_, rate): &(usize, f64)| rate.abs()).fold(0.0, f64::max);
                rates.retain(|(_, rate)| rate.abs() > FAR * most);
                bends.push(((pair[1].0 - pair[0].0) / root, rates));
            }
        }
        bends
    }

    /// The curvature of a piece at `t`; its derivatives are by the same unknowns at all places of the piece.
    fn curvature(&self, piece: &Piece, t: f64) -> Dependent {
        let (p, q) = piece.derivatives(t);
        let speed = p.norm();
        let kappa = (p.x * q.y - p.y * q.x) / speed.powi(3);
        let mut rates = Vec::new();
        for at in piece.cardinals(t) {
            let (own, first) = &self.ways[at.node];
            rates.extend(own.iter().enumerate().map(|(i, way)| {
                let (dp, dq) = (way * at.first, way * at.second);
                let turned = dp.x * q.y - dp.y * q.x + p.x * dq.y - p.y * dq.x;
                (first + i, turned / speed.powi(3) - 3.0 * kappa * p.dot(&dp) / (speed * speed))
            }));
        }
        (kappa, rates)
    }

    /// For each interval from a node to the next of its piece: its first node, its length and the angle by which the contour turns.
    pub fn turns(&self) -> Vec<(usize, f64, f64)> {
        let mut turns = Vec::new();
        for piece in &self.pieces {
            let angle = |t: f64| piece.spline.frame(t).alpha;
            for (i, knots) in piece.knots().windows(2).enumerate() {
                let turn = wrap_angle(angle(knots[1]) - angle(knots[0]));
                turns.push((piece.first + i, knots[1] - knots[0], turn));
            }
        }
        turns
    }
}

fn is_at_vertex(contact: &Contact) -> bool {
    matches!(contact.kind, ContactKind::Corner | ContactKind::Notch)
}
