//! All crossings of a strand and a boundary: pairs of arcs are halved until they are proven apart, or both are straight to
//! 1e-12, so that nothing thicker than that is stepped over.

use super::boundary::Boundary;
use super::strand::Strand;
use super::vector::{Point, between_segments, cross, distance, minus, nearest_on_segment, plus, segments_meet};

/// What counts as straight, and as rounding.
const STRAIGHT: f64 = 1e-12;
/// Pairs after which a search is given up, which is told.
const MOST_PAIRS: usize = 4_000_000;

/// A place where a strand and a boundary meet.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub s: f64,
    pub curve: usize,
    pub t: f64,
    /// Whether the strand comes into the solid here.
    pub enters: bool,
}

/// An arc between two parameters, and how far it is from its chord at most.
#[derive(Clone, Copy)]
struct Arc {
    from: f64,
    to: f64,
    start: Point,
    stop: Point,
    off: f64,
}

impl Arc {
    fn new(from: f64, to: f64, start: Point, stop: Point, bend: f64) -> Self {
        Self { from, to, start, stop, off: 0.125 * bend * (to - from) * (to - from) }
    }

    fn halves(&self, at: impl Fn(f64) -> Point, bend: impl Fn(f64, f64) -> f64) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        let point = at(middle);
        [
            Self::new(self.from, middle, self.start, point, bend(self.from, middle)),
            Self::new(middle, self.to, point, self.stop, bend(middle, self.to)),
        ]
    }

    fn meets(&self, b: &[f64; 4]) -> bool {
        let off = self.off + STRAIGHT;
        let ([ax, ay], [bx, by]) = (self.start, self.stop);
        ax.min(bx) - off <= b[2] && ax.max(bx) + off >= b[0] && ay.min(by) - off <= b[3] && ay.max(by) + off >= b[1]
    }
}

/// Crossings in the order of the strand between two of its parameters; the error where there are too many pairs to tell.
pub fn crossings(strand: &impl Strand, [from, to]: [f64; 2], boundary: &Boundary) -> Result<Vec<Crossing>, ()> {
    let whole = Arc::new(from, to, strand.at(from), strand.at(to), strand.bend(from, to));
    let mut search = Search { strand, boundary, found: Vec::new(), pairs: 0 };
    search.descend(whole, 0);
    if search.pairs > MOST_PAIRS {
        return Err(());
    }
    let mut found = search.found;
    found.sort_by(|a, b| a.s.total_cmp(&b.s));
    // the same one found on both sides of a node
    let same = |a: &Crossing, b: &Crossing| {
        let place = |c: &Crossing| boundary.curves[c.curve].point(c.t);
        a.enters == b.enters && (a.s - b.s).abs() < 1e-11 && distance(place(a), place(b)) < 1e-11
    };
    found.dedup_by(|a, b| same(a, b));
    Ok(found)
}

struct Search<'a, S> {
    strand: &'a S,
    boundary: &'a Boundary,
    found: Vec<Crossing>,
    pairs: usize,
}

impl<S: Strand> Search<'_, S> {
    fn descend(&mut self, arc: Arc, index: usize) {
        self.pairs += 1;
        let node = self.boundary.nodes[index];
        if self.pairs > MOST_PAIRS || !arc.meets(&node.bounds) {
            return;
        }
        let Some(halves) = node.halves else {
            let curve = &self.boundary.curves[node.first];
            let other = Arc::new(0.0, 1.0, curve.point(0.0), curve.point(1.0), curve.bend(0.0, 1.0));
            return self.compare(arc, node.first, other);
        };
        let size = (node.bounds[2] - node.bounds[0]).max(node.bounds[3] - node.bounds[1]);
        if arc.off > STRAIGHT && distance(arc.start, arc.stop).max(arc.off) > size {
            self.split(&arc).into_iter().for_each(|half| self.descend(half, index));
        } else {
            halves.into_iter().for_each(|half| self.descend(arc, half));
        }
    }

    fn split(&self, arc: &Arc) -> [Arc; 2] {
        arc.halves(|s| self.strand.at(s), |from, to| self.strand.bend(from, to))
    }

    fn compare(&mut self, arc: Arc, curve: usize, other: Arc) {
        self.pairs += 1;
        if self.pairs > MOST_PAIRS {
            return;
        }
        let apart = between_segments(arc.start, arc.stop, other.start, other.stop);
        if apart > arc.off + other.off + STRAIGHT {
            return;
        }
        if arc.off <= STRAIGHT && other.off <= STRAIGHT {
            return self.meet(&arc, curve, &other);
        }
        if arc.off >= other.off {
            self.split(&arc).into_iter().for_each(|half| self.compare(half, curve, other));
        } else {
            let shape = &self.boundary.curves[curve];
            let halves = other.halves(|t| shape.point(t), |from, to| shape.bend(from, to));
            halves.into_iter().for_each(|half| self.compare(arc, curve, half));
        }
    }

    /// Two straight ones.
    fn meet(&mut self, arc: &Arc, curve: usize, other: &Arc) {
        if !segments_meet(arc.start, arc.stop, other.start, other.stop) {
            return;
        }
        let (along, edge) = (minus(arc.stop, arc.start), minus(other.stop, other.start));
        let turned = cross(edge, along);
        // one line: nothing is crossed
        if turned == 0.0 {
            return;
        }
        let share = (cross(minus(other.start, arc.start), edge) / -turned).clamp(0.0, 1.0);
        // where the two are nearly parallel the place is not known, but the two points of it must fit each other
        let on_edge = nearest_on_segment(other.start, other.stop, plus(arc.start, share, along)).0;
        let (share, apart) = nearest_on_segment(arc.start, arc.stop, plus(other.start, on_edge, edge));
        // one after the other on one line
        if apart > STRAIGHT {
            return;
        }
        let at = |arc: &Arc, share: f64| arc.from + share * (arc.to - arc.from);
        self.found.push(Crossing { s: at(arc, share), curve, t: at(other, on_edge), enters: turned > 0.0 });
    }
}
