//! The rod's shape in a configuration: points along it, close enough for all that is asked about them.

use crate::configuration::{Configuration, Span, Spans};
use crate::path::ClampPath;
use crate::world::World;
use rod_core::{Station, stations};

/// Largest distance between the points. Between them the gap to an object is bounded by its slope (a rod moves through the
/// plane with unit speed, so the gap is 1-Lipschitz).
const SPACING: f64 = 1.0 / 32.0;

/// Points up to the last contact, at least: several a wave of the highest mode by which stability is judged.
const LOADED: f64 = 28.0;

/// Intervals of a span under load, at least, for Simpson's rule.
const FEWEST: usize = 4;

/// Largest distance between the points in the elastica's own wavelength, in units of the square root of EI over the force; and
/// the smallest one, whatever the force.
const LARGEST_PHASE: f64 = 0.5;
const SMALLEST_SPACING: f64 = 1.0 / 512.0;

/// A point of the rod.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub s: f64,
    pub at: Station,
    pub span: usize,
    /// The contact that is here.
    pub contact: Option<usize>,
    /// The rod is nowhere more curved between here and the tip.
    pub curved: f64,
}

/// The rod's segments, and points along all of it from the clamp to the tip. Up to the last contact those of a segment are an
/// odd number at equal distances.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub spans: Spans,
    pub nodes: Vec<Node>,
}

impl Shape {
    /// Becomes the shape of the rod in `configuration`, in the memory of the last one.
    pub fn follow(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) {
        let Self { spans, nodes } = self;
        *spans = configuration.spans(world, path);
        nodes.clear();
        let loaded = spans.last().map_or(0.0, |free| free.s);
        for (i, span) in spans.iter().enumerate() {
            let next = spans.get(i + 1);
            let node = |s, at, contact| Node { s, at, span: i, contact, curved: 0.0 };
            nodes.push(node(span.s, Station::from(&span.start), i.checked_sub(1)));
            let length = next.map_or(1.0, |next| next.s) - span.s;
            if length <= 0.0 {
                continue;
            }
            if next.is_none() {
                // no moment comes from beyond: it is straight
                let steps = (length / SPACING).ceil() as usize;
                let Station { x, y, cos, sin, .. } = nodes[nodes.len() - 1].at;
                let at = |s: f64| Station { x: x + s * cos, y: y + s * sin, cos, sin, kappa: 0.0 };
                let part = |k: usize| length * (k as f64 / steps as f64);
                nodes.extend((1..=steps).map(|k| node(span.s + part(k), at(part(k)), None)));
                continue;
            }
            let steps = 2 * ((0.5 * length / spacing(span).min(loaded / LOADED)).ceil() as usize).max(FEWEST / 2);
            let h = length / steps as f64;
            // the last point of a span is the first of the next, where it is known better
            let between = stations(&span.start, span.a, span.b, length, steps).take(steps - 1).enumerate();
            nodes.extend(between.map(|(k, at)| node(span.s + h * (k + 1) as f64, at, None)));
        }
        bound_curvature(spans, nodes);
    }

    /// The points of span number `i` with both its ends.
    pub fn along(&self, i: usize) -> &[Node] {
        let first = self.nodes.partition_point(|node| node.span < i);
        let last = self.nodes.partition_point(|node| node.span <= i);
        &self.nodes[first..(last + 1).min(self.nodes.len())]
    }
}

/// Finds how curved the rod is from each node on: between two of them the curvature changes no faster than by the force.
fn bound_curvature(spans: &[Span], nodes: &mut [Node]) {
    let (mut most, mut after) = (0.0_f64, (1.0, 0.0));
    let (mut span, mut force) = (usize::MAX, 0.0);
    for node in nodes.iter_mut().rev() {
        if node.span != span {
            span = node.span;
            force = spans[span].a.hypot(spans[span].b);
        }
        let own = node.at.kappa.abs();
        most = most.max(own.max(after.1) + 0.5 * force * (after.0 - node.s));
        node.curved = most;
        after = (node.s, own);
    }
}

/// Distance between the points of a span under load.
fn spacing(span: &Span) -> f64 {
    (LARGEST_PHASE / span.a.hypot(span.b).sqrt()).clamp(SMALLEST_SPACING, SPACING)
}
