//! The rod's shape in a configuration: points along it, close enough for all that is asked about them.

use crate::contact_set::{Configuration, Segments, USUAL_SEGMENTS};
use crate::scene::Setup;
use crate::scene::rod::{self, Segment, lead};
use rod_contours::Bounds;
use rod_core::{Cut, PhysicalRod, RodModel, Station};
use smallvec::{SmallVec, smallvec};

/// Largest distance between the points. Between them the gap to an object is bounded by values and slopes at both ends; the prover
/// halves what that does not settle. Twice as many cost more than is halved less.
const SPACING: f64 = 1.0 / 10.0;

/// The same of a shape whose points stand for the rod between them.
const FINE: f64 = 1.0 / 32.0;
/// Least number of intervals of that up to the last contact, several a wave of the highest mode of the stability test, and of a
/// segment under load, for Simpson's rule.
const LOADED: f64 = 28.0;
const FEWEST: usize = 4;

/// Largest distance between the points in units of sqrt(E I / force), the length scale of the elastica; and the smallest
/// distance (L), whatever the force.
const LARGEST_PHASE: f64 = 0.5;
const SMALLEST_SPACING: f64 = 1.0 / 512.0;

/// Points for which memory is reserved: most shapes have fewer.
const USUAL: usize = 24;

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

/// The rod's segments, and points along all of it from the clamp to the tip. Those of a segment under load are at equal distances.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub segments: Segments,
    pub nodes: Vec<Node>,
    /// Index of the first point of each segment: beyond the first segment, of the contact there.
    firsts: SmallVec<[usize; USUAL_SEGMENTS]>,
    /// Size of the force on each segment.
    forces: SmallVec<[f64; USUAL_SEGMENTS]>,
    /// Number of segments between the clamp and a roller: 1 where a rod under load runs through one, else 0.
    lead: usize,
}

impl Shape {
    /// A straight line from a point on.
    pub fn straight((x, y): (f64, f64), phi: f64, length: f64) -> Self {
        let start = Cut { x, y, phi, moment: 0.0 };
        let at = Station::from(&start);
        let end = Station { x: x + length * at.cos, y: y + length * at.sin, ..at };
        let node = |s, at| Node { s, at, segment: 0, bulge: 0.0 };
        Self {
            segments: smallvec![Segment { s: 0.0, start, a: 0.0, b: 0.0 }],
            nodes: vec![node(0.0, at), node(length, end)],
            firsts: smallvec![0],
            forces: smallvec![0.0],
            lead: 0,
        }
    }

    /// The shape of the rod in `configuration`, in the memory of the points of another one.
    pub fn of<R: PhysicalRod>(memory: Vec<Node>, setup: &Setup<'_, R>, configuration: &Configuration) -> Self {
        Self::bare(memory, setup, configuration).with_points(setup.rod.model())
    }

    /// The same without points, whose memory it keeps.
    pub fn bare<R: PhysicalRod>(mut memory: Vec<Node>, setup: &Setup<'_, R>, configuration: &Configuration) -> Self {
        memory.clear();
        let segments = configuration.segments(setup);
        let lead = lead(&segments, configuration.count());
        let forces = forces(&segments);
        Self { segments, nodes: memory, firsts: SmallVec::new(), forces, lead }
    }

    /// The same with points.
    pub fn with_points(self, rod: &impl RodModel) -> Self {
        Self::through(self.nodes, rod, self.segments, self.lead, |from, to, force, _| {
            (((to - from) / spacing(rod, (from, to), force, SPACING)).ceil() as usize).max(1)
        })
    }

    /// The same with points so close that the chords between them, or an integral by Simpson's rule, may stand for the rod: an odd
    /// number of them on each segment.
    pub fn refine(&self, rod: &impl RodModel) -> Self {
        let memory = Vec::with_capacity(USUAL);
        Self::through(memory, rod, self.segments.clone(), self.lead, |from, to, force, loaded| {
            let spacing = spacing(rod, (from, to), force, FINE).min(if from < loaded { loaded / LOADED } else { FINE });
            2 * ((0.5 * (to - from) / spacing).ceil() as usize).max(FEWEST / 2)
        })
    }

    /// Points along `segments`: on each one, by its arc lengths, its force and the arc length of the last contact, so many steps. The
    /// free end of a rod that is straight at rest is one.
    fn through(
        mut nodes: Vec<Node>,
        rod: &impl RodModel,
        segments: Segments,
        lead: usize,
        steps: impl Fn(f64, f64, f64, f64) -> usize,
    ) -> Self {
        nodes.clear();
        let mut firsts = SmallVec::new();
        let forces = forces(&segments);
        let loaded = segments.last().map_or(0.0, |free| free.s);
        for (i, segment) in segments.iter().enumerate() {
            let next = segments.get(i + 1);
            let node = |s, at| Node { s, at, segment: i, bulge: 0.0 };
            let start = Station::from(&segment.start);
            firsts.push(nodes.len());
            nodes.push(node(segment.s, start));
            let to = next.map_or(1.0, |next| next.s);
            let length = to - segment.s;
            if length <= 0.0 {
                continue;
            }
            if next.is_none() && rod.is_straight() {
                let Station { x, y, cos, sin, .. } = start;
                let tip = Station { x: x + length * cos, y: y + length * sin, cos, sin, moment: 0.0 };
                nodes.push(node(1.0, tip));
                continue;
            }
            let steps = steps(segment.s, to, forces[i], loaded);
            let h = length / steps as f64;
            // the last point of a segment is the first of the next, where it is known better
            let count = if next.is_some() { steps - 1 } else { steps };
            let mut k = 0.0;
            rod.stations(segment, (length, steps), count, |at| {
                k += 1.0;
                nodes.push(node((segment.s + h * k).min(1.0), at));
            });
        }
        bulge(rod, &forces, &mut nodes, &firsts);
        Self { segments, nodes, firsts, forces, lead }
    }

    /// Where the clamp and the tip are.
    pub fn ends(&self) -> ((f64, f64), (f64, f64)) {
        let [first, last] = [&self.nodes[0], &self.nodes[self.nodes.len() - 1]].map(|node| (node.at.x, node.at.y));
        (first, last)
    }

    /// A box around the rod.
    pub fn bounds(&self) -> Bounds {
        let points = self.nodes.iter().fold(Bounds::EMPTY, |all, node| all.with(node.at.x, node.at.y));
        points.grown(self.nodes.iter().map(|node| node.bulge).fold(0.0, f64::max))
    }

    /// Size of the force on a segment.
    pub fn force(&self, segment: usize) -> f64 {
        self.forces[segment]
    }

    /// The last point of a segment: beyond it, if another segment begins there, the two share it.
    pub fn last_of(&self, segment: usize) -> usize {
        self.firsts.get(segment + 1).copied().unwrap_or(self.nodes.len() - 1)
    }

    /// The point that is at contact number `j`.
    pub fn node_of(&self, j: usize) -> usize {
        self.firsts[j + 1 + self.lead]
    }

    /// Number of segments between the clamp and a roller: so many come before the one that leads to the first contact.
    pub fn lead(&self) -> usize {
        self.lead
    }

    /// The points of segment number `i` with both its ends.
    pub fn along(&self, i: usize) -> &[Node] {
        let after = self.firsts.get(i + 1).map_or(self.nodes.len(), |next| next + 1);
        &self.nodes[self.firsts[i]..after]
    }
}

/// Size of the force on each segment.
fn forces(segments: &[Segment]) -> SmallVec<[f64; USUAL_SEGMENTS]> {
    segments.iter().map(|segment| segment.a.hypot(segment.b)).collect()
}

/// Finds how far the rod leaves the chords between its points.
fn bulge(rod: &impl RodModel, forces: &[f64], nodes: &mut [Node], firsts: &[usize]) {
    // what is free and straight is its own chord
    let bent = if rod.is_straight() { forces.len() - 1 } else { forces.len() };
    for (i, force) in forces.iter().enumerate().take(bent) {
        let last = firsts.get(i + 1).copied().unwrap_or(nodes.len() - 1);
        for k in firsts[i]..last {
            nodes[k].bulge = rod::bulge(rod, (nodes[k].s, &nodes[k].at), (nodes[k + 1].s, &nodes[k + 1].at), *force);
        }
    }
}

/// Distance between the points of a segment from one arc length to another, at most `most`.
fn spacing(rod: &impl RodModel, (from, to): (f64, f64), force: f64, most: f64) -> f64 {
    (LARGEST_PHASE / rod::phase_rate(rod, from, to, force)).clamp(SMALLEST_SPACING, most)
}
