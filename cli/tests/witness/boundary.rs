//! The boundary of one object: its curves in order, with boxes around runs of them.

use super::curve::Curve;
use super::vector::{cross, distance};

/// A run of curves and the box around it.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub bounds: [f64; 4],
    pub first: usize,
    pub end: usize,
    /// The two halves, where it is more than one curve.
    pub halves: Option<[usize; 2]>,
}

#[derive(Debug)]
pub struct Boundary {
    pub curves: Vec<Curve>,
    pub closed: bool,
    /// Whether the solid is outside: it is travelled clockwise.
    pub cavity: bool,
    pub nodes: Vec<Node>,
}

/// Farther apart than this the last point of a curve and the first of the next are joined by a line.
const APART: f64 = 1e-13;

impl Boundary {
    pub fn new(pieces: Vec<Curve>) -> Self {
        let mut curves: Vec<Curve> = Vec::new();
        for curve in pieces {
            if let Some(last) = curves.last() {
                let (from, to) = (last.point(1.0), curve.point(0.0));
                if distance(from, to) > APART {
                    curves.push(Curve::Line { from, to });
                }
            }
            curves.push(curve);
        }
        let ends = [curves[0].point(0.0), curves[curves.len() - 1].point(1.0)];
        let closed = distance(ends[0], ends[1]) < 1e-8;
        if closed && distance(ends[0], ends[1]) > APART {
            curves.push(Curve::Line { from: ends[1], to: ends[0] });
        }
        let cavity = closed && area(&curves) < 0.0;
        let mut boundary = Self { curves, closed, cavity, nodes: Vec::new() };
        boundary.grow(0, boundary.curves.len());
        boundary
    }

    /// Adds the tree over a run of curves and tells its root; that of all is node 0.
    fn grow(&mut self, first: usize, end: usize) -> usize {
        let index = self.nodes.len();
        let bounds = self.curves[first].bounds();
        self.nodes.push(Node { bounds, first, end, halves: None });
        if end - first > 1 {
            let middle = first.midpoint(end);
            let halves = [self.grow(first, middle), self.grow(middle, end)];
            let [a, b] = halves.map(|half| self.nodes[half].bounds);
            self.nodes[index].bounds = [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])];
            self.nodes[index].halves = Some(halves);
        }
        index
    }
}

/// The area within, negative where it is travelled clockwise, as exact as a sign needs.
fn area(curves: &[Curve]) -> f64 {
    const PARTS: u32 = 16;
    let at = |curve: &Curve, k: u32| curve.point(f64::from(k) / f64::from(PARTS));
    let part = |curve: &Curve| (0..PARTS).map(|k| cross(at(curve, k), at(curve, k + 1))).sum::<f64>();
    curves.iter().map(part).sum()
}
