//! How deep a strand is in the solid: at each passage, how far the part of the boundary that it cuts off reaches beyond it.

use super::boundary::Boundary;
use super::crossing::{Crossing, crossings};
use super::nearest::nearest;
use super::side::is_inside;
use super::strand::Strand;
use super::vector::{Point, distance, nearest_on_segment};

/// Points of each curve of a part cut off, and of the strand within.
const POINTS: usize = 24;

/// Depths that are those of rounding, whatever they are exactly.
const ROUNDING: f64 = 1e-10;

/// The deepest place of a strand in a solid.
#[derive(Clone, Copy, Debug)]
pub struct Deepest {
    pub s: f64,
    pub depth: f64,
}

/// The deepest place; none where the strand crosses nothing. The error where it cannot be told.
pub fn deepest(strand: &impl Strand, boundary: &Boundary) -> Result<Option<Deepest>, ()> {
    let found = crossings(strand, [0.0, 1.0], boundary)?;
    let mut places: Vec<Deepest> = Vec::new();
    // A touch may count as no crossing, as one or as two: what is between two of them is asked for, not counted.
    for pair in found.windows(2) {
        let (s, depth) = (0.5 * (pair[0].s + pair[1].s), passage(strand, boundary, pair[0], pair[1]));
        if depth > ROUNDING && is_inside(boundary, strand.at(s)) {
            places.push(Deepest { s, depth });
        }
    }
    let ends = found.first().zip(found.last()).map_or([[0.0, 1.0]; 2], |(a, b)| [[0.0, a.s], [b.s, 1.0]]);
    for [from, to] in ends {
        if is_inside(boundary, strand.at(0.5 * (from + to))) {
            places.push(sampled(strand, boundary, [from, to]));
        }
    }
    Ok(places.into_iter().max_by(|a, b| a.depth.total_cmp(&b.depth)))
}

/// The deepest of some points between two places.
fn sampled(strand: &impl Strand, boundary: &Boundary, [from, to]: [f64; 2]) -> Deepest {
    let mut deepest = Deepest { s: to, depth: 0.0 };
    for k in 0..=4 * POINTS {
        let s = from + (to - from) * k as f64 / (4 * POINTS) as f64;
        let point = strand.at(s);
        let depth = nearest(boundary, point).distance;
        if depth > deepest.depth && is_inside(boundary, point) {
            deepest = Deepest { s, depth };
        }
    }
    deepest
}

/// How far the strand is from the boundary between an entry and an exit, by the nearer of the two ways around.
fn passage(strand: &impl Strand, boundary: &Boundary, entry: Crossing, exit: Crossing) -> f64 {
    let n = boundary.curves.len();
    let (here, there) = ((entry.curve, entry.t), (exit.curve, exit.t));
    let ahead = (exit.curve + n - entry.curve) % n + if entry.curve == exit.curve && exit.t < entry.t { n } else { 0 };
    let back = (entry.curve + n - exit.curve) % n + if entry.curve == exit.curve && entry.t < exit.t { n } else { 0 };
    let ways = [(ahead, here, there), (back, there, here)];
    let ways = if ahead <= back { ways } else { [ways[1], ways[0]] };
    let mut least = f64::INFINITY;
    for (curves, from, to) in ways {
        if boundary.closed || from.0 + curves < n {
            least = least.min(apart(strand, [entry.s, exit.s], boundary, (from, to, curves), least));
        }
    }
    least
}

type Way = ((usize, f64), (usize, f64), usize);

/// The largest distance of a part of the boundary and one of the strand; not on beyond `enough`.
fn apart(strand: &impl Strand, s: [f64; 2], boundary: &Boundary, (from, to, curves): Way, enough: f64) -> f64 {
    let n = boundary.curves.len();
    let at = |k: usize| s[0] + (s[1] - s[0]) * k as f64 / POINTS as f64;
    let line: Vec<Point> = (0..=POINTS).map(|k| strand.at(at(k))).collect();
    let (mut most, mut edge): (f64, Vec<Point>) = (0.0, Vec::new());
    for k in 0..=curves {
        let curve = &boundary.curves[(from.0 + k) % n];
        let (start, stop) = (if k == 0 { from.1 } else { 0.0 }, if k == curves { to.1 } else { 1.0 });
        let parts = if curve.bend(0.0, 1.0) == 0.0 { 1 } else { POINTS };
        for i in 0..=parts {
            let point = curve.point(start + (stop - start) * i as f64 / parts as f64);
            most = most.max(from_line(strand, s, &line, point));
            edge.push(point);
        }
        if most >= enough {
            return most;
        }
    }
    // the strand may go farther in than the boundary shows
    for point in &line {
        let near = edge.windows(2).map(|pair| nearest_on_segment(pair[0], pair[1], *point).1);
        most = most.max(near.fold(f64::INFINITY, f64::min));
    }
    most
}

/// Distance of a point from a part of a strand.
fn from_line(strand: &impl Strand, s: [f64; 2], line: &[Point], point: Point) -> f64 {
    let near = line.windows(2).map(|pair| nearest_on_segment(pair[0], pair[1], point)).enumerate();
    let Some((k, (share, mut far))) = near.min_by(|a, b| a.1.1.total_cmp(&b.1.1)) else { return 0.0 };
    let step = (s[1] - s[0]) / (line.len() - 1) as f64;
    // known well enough where the chords are the curve, and small
    let off = 0.125 * strand.bend(s[0], s[1]) * step * step;
    if far + off < ROUNDING {
        return far;
    }
    // else exactly, by thirds
    let (mut lo, mut hi) = (s[0] + step * (k as f64 + share - 0.5), s[0] + step * (k as f64 + share + 0.5));
    (lo, hi) = (lo.max(s[0]), hi.min(s[1]));
    for _ in 0..40 {
        let (a, b) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
        let (p, q) = (distance(strand.at(a), point), distance(strand.at(b), point));
        if p < q {
            hi = b
        } else {
            lo = a
        }
        far = p.min(q);
    }
    far
}
