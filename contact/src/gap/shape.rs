//! The rod's shape in a configuration: points along it, close enough for all that is asked about them.

use crate::contact_set::{Configuration, Segments};
use crate::scene::setup::Setup;
use rod_contours::Bounds;
use rod_core::{Section, Segment, Station, stations};
use smallvec::{SmallVec, smallvec};

/// Largest distance between the points. Between them the gap to an object is bounded by its slope (a rod moves through the
/// plane with unit speed, so the gap is 1-Lipschitz).
const SPACING: f64 = 1.0 / 32.0;

/// Intervals of the straight end of the rod. The prover halves them where it needs more.
const STRAIGHT: usize = 4;

/// Least number of points up to the last contact: several a wave of the highest mode of the stability test.
const LOADED: f64 = 28.0;

/// Least number of intervals of a segment under load, for Simpson's rule.
const FEWEST: usize = 4;

/// Largest distance between the points in units of sqrt(E I / force), the length scale of the elastica; and the smallest
/// distance (L), whatever the force.
const LARGEST_PHASE: f64 = 0.5;
const SMALLEST_SPACING: f64 = 1.0 / 512.0;

/// Points for which memory is reserved: most shapes have fewer.
const USUAL: usize = 80;

/// A point of the rod.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub s: f64,
    pub at: Station,
    pub segment: usize,
    /// How far at most the rod leaves the chord from here to the next point.
    pub bulge: f64,
}

impl Node {
    /// Whether the rod from here to the `next` point is farther than `reach` on one side of a box.
    pub fn is_beyond(&self, next: &Self, bounds: &Bounds, reach: f64) -> bool {
        let (a, b, grown) = (&self.at, &next.at, self.bulge + reach);
        a.x.max(b.x) + grown < bounds.min[0]
            || a.x.min(b.x) - grown > bounds.max[0]
            || a.y.max(b.y) + grown < bounds.min[1]
            || a.y.min(b.y) - grown > bounds.max[1]
    }
}

/// The rod's segments, and points along all of it from the clamp to the tip. Up to the last contact those of a segment are an
/// odd number at equal distances.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub segments: Segments,
    pub nodes: Vec<Node>,
    /// Index of the first point of each segment: beyond the first segment, of the contact there.
    firsts: SmallVec<[usize; 9]>,
    /// Size of the force on each segment.
    forces: SmallVec<[f64; 9]>,
}

impl Shape {
    /// A straight line from a point on.
    pub fn straight((x, y): (f64, f64), phi: f64, length: f64) -> Self {
        let start = Section { x, y, phi, kappa: 0.0 };
        let at = Station::from(&start);
        let end = Station { x: x + length * at.cos, y: y + length * at.sin, ..at };
        let node = |s, at| Node { s, at, segment: 0, bulge: 0.0 };
        Self {
            segments: smallvec![Segment { s: 0.0, start, a: 0.0, b: 0.0 }],
            nodes: vec![node(0.0, at), node(length, end)],
            firsts: smallvec![0],
            forces: smallvec![0.0],
        }
    }

    /// The shape of the rod in `configuration`.
    pub fn of(setup: &Setup<'_>, configuration: &Configuration) -> Self {
        let mut shape = Self { nodes: Vec::with_capacity(USUAL), ..Self::default() };
        shape.follow(setup, configuration);
        shape
    }

    fn follow(&mut self, setup: &Setup<'_>, configuration: &Configuration) {
        let Self { segments, nodes, firsts, forces } = self;
        *segments = configuration.segments(setup);
        forces.clear();
        forces.extend(segments.iter().map(|segment| segment.a.hypot(segment.b)));
        nodes.clear();
        firsts.clear();
        let loaded = segments.last().map_or(0.0, |free| free.s);
        for (i, segment) in segments.iter().enumerate() {
            let next = segments.get(i + 1);
            let node = |s, at| Node { s, at, segment: i, bulge: 0.0 };
            firsts.push(nodes.len());
            nodes.push(node(segment.s, Station::from(&segment.start)));
            let length = next.map_or(1.0, |next| next.s) - segment.s;
            if length <= 0.0 {
                continue;
            }
            if next.is_none() {
                // no moment comes from beyond: it is straight
                let steps = STRAIGHT;
                let Station { x, y, cos, sin, .. } = nodes[nodes.len() - 1].at;
                let at = |s: f64| Station { x: x + s * cos, y: y + s * sin, cos, sin, kappa: 0.0 };
                let part = |k: usize| length * (k as f64 / steps as f64);
                nodes.extend((1..=steps).map(|k| node(segment.s + part(k), at(part(k)))));
                continue;
            }
            let steps = 2 * ((0.5 * length / spacing(forces[i]).min(loaded / LOADED)).ceil() as usize).max(FEWEST / 2);
            let h = length / steps as f64;
            // the last point of a segment is the first of the next, where it is known better
            let between = stations(&segment.start, segment.a, segment.b, length, steps).take(steps - 1).enumerate();
            nodes.extend(between.map(|(k, at)| node(segment.s + h * (k + 1) as f64, at)));
        }
        bulge(forces, nodes, firsts);
    }

    /// Where the clamp and the tip are.
    pub fn ends(&self) -> ((f64, f64), (f64, f64)) {
        let [first, last] = [&self.nodes[0], &self.nodes[self.nodes.len() - 1]].map(|node| (node.at.x, node.at.y));
        (first, last)
    }

    /// A box around the points.
    pub fn bounds(&self) -> Bounds {
        self.nodes.iter().fold(Bounds::EMPTY, |all, node| all.with(node.at.x, node.at.y))
    }

    /// Size of the force on a segment.
    pub fn force(&self, segment: usize) -> f64 {
        self.forces[segment]
    }

    /// The last point of a segment: beyond it, if another segment begins there, the two share it.
    pub fn last_of(&self, segment: usize) -> usize {
        self.firsts.get(segment + 1).copied().unwrap_or(self.nodes.len() - 1)
    }

    /// The contact at a point, if there is one.
    pub fn contact_at(&self, node: usize) -> Option<usize> {
        self.firsts[1..].iter().position(|first| *first == node)
    }

    /// The points of segment number `i` with both its ends.
    pub fn along(&self, i: usize) -> &[Node] {
        let after = self.firsts.get(i + 1).map_or(self.nodes.len(), |next| next + 1);
        &self.nodes[self.firsts[i]..after]
    }
}

/// Finds how far the rod leaves the chords between the points of the segments under load: between two of them the curvature
/// changes no faster than by the force.
fn bulge(forces: &[f64], nodes: &mut [Node], firsts: &[usize]) {
    for (force, ends) in forces.iter().zip(firsts.windows(2)) {
        let half_force = 0.5 * force;
        for i in ends[0]..ends[1] {
            let (h, after) = (nodes[i + 1].s - nodes[i].s, nodes[i + 1].at.kappa.abs());
            nodes[i].bulge = 0.125 * h * h * (nodes[i].at.kappa.abs().max(after) + half_force * h);
        }
    }
}

/// Distance between the points of a segment under load.
fn spacing(force: f64) -> f64 {
    (LARGEST_PHASE / force.sqrt()).clamp(SMALLEST_SPACING, SPACING)
}
