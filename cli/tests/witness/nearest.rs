//! The nearest point of a boundary, by halving all that may hold it.

use super::boundary::Boundary;
use super::vector::{Point, distance, nearest_on_segment};

/// How exact the distance is.
const EXACT: f64 = 1e-13;

/// A point of a boundary.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    pub curve: usize,
    pub t: f64,
    pub distance: f64,
}

/// The nearest point to this one.
pub fn nearest(boundary: &Boundary, point: Point) -> Nearest {
    let mut best = Nearest { curve: 0, t: 0.0, distance: f64::INFINITY };
    descend(boundary, 0, point, &mut best);
    best
}

fn descend(boundary: &Boundary, index: usize, point: Point, best: &mut Nearest) {
    let node = boundary.nodes[index];
    if box_distance(&node.bounds, point) > best.distance {
        return;
    }
    let Some([a, b]) = node.halves else {
        return on_curve(boundary, node.first, [0.0, 1.0], point, best);
    };
    let far = |half: usize| box_distance(&boundary.nodes[half].bounds, point);
    let (first, second) = if far(a) <= far(b) { (a, b) } else { (b, a) };
    descend(boundary, first, point, best);
    descend(boundary, second, point, best);
}

fn on_curve(boundary: &Boundary, index: usize, [from, to]: [f64; 2], point: Point, best: &mut Nearest) {
    let curve = &boundary.curves[index];
    let off = 0.125 * curve.bend(from, to) * (to - from) * (to - from);
    let (start, stop) = (curve.point(from), curve.point(to));
    let (share, far) = nearest_on_segment(start, stop, point);
    if far - off > best.distance {
        return;
    }
    let t = from + share * (to - from);
    let here = distance(curve.point(t), point);
    if here < best.distance {
        *best = Nearest { curve: index, t, distance: here };
    }
    if off > EXACT {
        let middle = 0.5 * (from + to);
        let near_start = distance(start, point) <= distance(stop, point);
        let halves = if near_start { [[from, middle], [middle, to]] } else { [[middle, to], [from, middle]] };
        halves.into_iter().for_each(|half| on_curve(boundary, index, half, point, best));
    }
}

fn box_distance(b: &[f64; 4], [x, y]: Point) -> f64 {
    (b[0] - x).max(x - b[2]).max(0.0).hypot((b[1] - y).max(y - b[3]).max(0.0))
}
