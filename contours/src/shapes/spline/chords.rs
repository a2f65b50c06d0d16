//! How far the cubics of a spline leave their chords, so that distant ones are passed over together.

use std::ops::Range as Span;

use crate::Point;
use crate::point::{dot, minus, plus};
use crate::shapes::cubic::Cubic;

/// A binary tree over the cubics: a node covers a run of them and knows within what distance of the chord from its first
/// point to its last one they stay. Where the curve is smooth that is the square of what a box leaves open.
///
/// A node over `n` cubics is followed by its left half (`n / 2` of them, hence `2 (n / 2) - 1` nodes) and then by its right
/// half. That is 16 bytes a cubic.
#[derive(Clone, Debug)]
pub(super) struct Chords {
    /// For each node the largest distance of its cubics from its chord.
    widths: Vec<f64>,
}

/// A node with the cubics it covers.
#[derive(Clone, Copy)]
struct Node {
    index: usize,
    first: usize,
    end: usize,
}

impl Node {
    fn halves(self) -> [Self; 2] {
        let middle = self.first.midpoint(self.end);
        [
            Self { index: self.index + 1, end: middle, ..self },
            Self { index: self.index + 2 * (middle - self.first), first: middle, ..self },
        ]
    }

    fn is_single(self) -> bool {
        self.end == self.first + 1
    }
}

/// The query of [`Chords::visit`].
struct Visit<'a, P, F> {
    span: Span<usize>,
    seen_from: Point,
    points: P,
    limit: f64,
    look: &'a mut F,
}

impl Chords {
    /// The tree over so many cubics, at least one.
    pub fn new(cubics: usize, cubic: impl Fn(usize) -> Cubic) -> Self {
        let mut tree = Self { widths: vec![0.0; 2 * cubics - 1] };
        tree.fill(tree.root(), &cubic);
        tree
    }

    /// Calls `look` with the cubics of the span that may be nearer to a place than what has been seen, nearer chords first;
    /// `look` returns the least distance seen so far. `points` are the ends of the cubics.
    pub fn visit(
        &self,
        span: Span<usize>,
        seen_from: Point,
        points: impl Fn(usize) -> Point,
        look: &mut impl FnMut(usize) -> f64,
    ) {
        // Straight down to the run that the span is in: a short part of a long spline costs what it is long.
        let mut node = self.root();
        while !node.is_single() {
            let [left, right] = node.halves();
            if span.end <= left.end {
                node = left;
            } else if span.start >= right.first {
                node = right;
            } else {
                break;
            }
        }
        self.descend(node, 0.0, &mut Visit { span, seen_from, points, limit: f64::INFINITY, look });
    }

    fn root(&self) -> Node {
        Node { index: 0, first: 0, end: self.widths.len().div_ceil(2) }
    }

    /// Fills in the node and those below; returns its width.
    fn fill(&mut self, node: Node, cubic: &impl Fn(usize) -> Cubic) -> f64 {
        let width = if node.is_single() {
            let [start, second, third, stop] = cubic(node.first).control;
            distance(start, stop, second).max(distance(start, stop, third))
        } else {
            let [left, right] = node.halves();
            let within = self.fill(left, cubic).max(self.fill(right, cubic));
            // The distance from a chord is a convex function: on a half's chord it is largest where the halves meet.
            let (start, stop) = (cubic(node.first).control[0], cubic(node.end - 1).control[3]);
            within + distance(start, stop, cubic(right.first).control[0])
        };
        self.widths[node.index] = width;
        width
    }

    /// `nearest` is a lower bound of the distance of the node's cubics.
    fn descend<P, F>(&self, node: Node, nearest: f64, visit: &mut Visit<'_, P, F>)
    where
        P: Fn(usize) -> Point,
        F: FnMut(usize) -> f64,
    {
        let outside = node.end <= visit.span.start || visit.span.end <= node.first;
        if outside || nearest > visit.limit {
            return;
        }
        if node.is_single() {
            visit.limit = (visit.look)(node.first);
            return;
        }
        let halves = node.halves();
        let [left, right] = halves.map(|half| {
            let chord = distance((visit.points)(half.first), (visit.points)(half.end), visit.seen_from);
            // Rounding must not put a cubic beyond its own distance.
            chord * (1.0 - 8.0 * f64::EPSILON) - self.widths[half.index]
        });
        if left <= right {
            self.descend(halves[0], left, visit);
            self.descend(halves[1], right, visit);
        } else {
            self.descend(halves[1], right, visit);
            self.descend(halves[0], left, visit);
        }
    }
}

/// The distance of a point from the chord between two others.
fn distance(start: Point, stop: Point, point: Point) -> f64 {
    let (chord, way) = (minus(stop, start), minus(point, start));
    let along = dot(way, chord) / dot(chord, chord);
    // The chord of a closed curve is a point.
    let along = if along.is_nan() { 0.0 } else { along.clamp(0.0, 1.0) };
    let away = plus(way, -along, chord);
    dot(away, away).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic of an arc of the unit circle.
    fn arc(from: f64, to: f64) -> Cubic {
        let handle = 4.0 / 3.0 * (0.25 * (to - from)).tan();
        let [(y, x), (v, u)] = [from, to].map(f64::sin_cos);
        let control = [[x, y], [x - handle * y, y + handle * x], [u + handle * v, v - handle * u], [u, v]];
        Cubic { control, from, width: to - from }
    }

    #[test]
    fn only_the_near_ones_of_the_span_are_looked_at() {
        for cubics in 1..80_usize {
            let angle = |k: usize| 6.0 * k as f64 / cubics as f64;
            let cubic = |k: usize| arc(angle(k), angle(k + 1));
            let tree = Chords::new(cubics, cubic);
            for span in [0..cubics, cubics / 3..cubics, cubics / 2..cubics / 2 + 1] {
                for at in [0.1, 2.5, 4.4] {
                    let place = [1.5 * f64::cos(at), 1.5 * f64::sin(at)];
                    let far = |k: usize| {
                        let sample = |step: u32| minus(cubic(k).point(f64::from(step) / 64.0), place);
                        (0..=64).map(sample).map(|way| dot(way, way).sqrt()).fold(f64::INFINITY, f64::min)
                    };
                    let (mut seen, mut least) = (Vec::new(), f64::INFINITY);
                    tree.visit(span.clone(), place, |k| [angle(k).cos(), angle(k).sin()], &mut |k| {
                        seen.push(k);
                        least = least.min(far(k));
                        least
                    });
                    assert_eq!(least, span.clone().map(far).fold(f64::INFINITY, f64::min), "{cubics} {span:?} {at}");
                    assert!(
                        seen.len() <= 8 && seen.iter().all(|k| span.contains(k)),
                        "{cubics} {span:?} {at}: {seen:?}"
                    );
                }
            }
        }
    }
}
