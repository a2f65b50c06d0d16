//! A proof that the rod stays outside of the objects, or the places where it does not.
//!
//! The rod is cut into intervals, the contours into [runs](rod_contours::Run) that bend one way. An interval is clear of a
//! run if a line separates the two (mostly one that an earlier interval or state has found), if rod and run are parallel at
//! a point from which on the rod curves towards the solid no more than the run, or if the distances of its ends from the
//! run add up to more than its length. Otherwise it is halved. A part of the rod that meets no run lies wholly inside or
//! wholly outside: the sign of the distance, at the clamp and behind each interval that may touch, decides which.

mod arcs;
mod candidates;
mod compare;
mod sides;

use super::interval::{Interval, Knot};
use super::separator::{Line, Lines};
use super::touch::Rod;
use super::{Crossing, GAP_TOLERANCE};
use crate::contact_set::Configuration;
use crate::gap::shape::{Node, Shape};
use crate::scene::world::{RunFoot, World};
use rod_contours::Run;
use rod_core::{RodModel, Uniform};
use smallvec::SmallVec;

/// Length (L) below which an interval is not halved. Its points are at most half of it deeper than its ends.
const SHORTEST: f64 = 1e-12;
/// Ratio of the proven depth and the depth at which a point counts as inside. At 1, an interval next to a flat contact would be
/// halved millions of times.
const PROVEN: f64 = 10.0;
/// Largest turn (rad) of rod and contour over an interval on which their curvatures are compared. The comparison needs their
/// angles to stay below a right angle.
const LARGEST_TURN: f64 = 0.5;
/// Bound (L) at or below which an interval may touch the contour. The rod beyond it may be on the other side, which is tested.
const GATE: f64 = 1e-12;
/// Largest number of runs shorter than an interval whose boxes it may meet. With more it is halved first. Longer runs do not count: where
/// they overlap, halves meet as many of them, and halving would not end.
const CROWD: usize = 12;
/// Largest difference of the smallest gap seen of a free rod and the proven one, relative. Smaller values cost more halvings.
const BESIDE: f64 = 1e-3;
/// Length of the shortest intervals of a free rod, over its gap.
const COARSE: f64 = 1e-3;
/// Gap (L) of a free rod below which only the sign is proven.
const NEARLY_CLOSED: f64 = 1e-9;
/// Number of discs without solid that are kept of each object.
const DISCS: usize = 4;
/// Least share of an interval in a halving.
const LEAST_SHARE: f64 = 0.1;
/// Limit of parts of intervals in one proof; a state takes some tens. Beyond it nothing is proven.
const MOST_LOOKS: usize = 100_000;

/// Largest number of states for which the proof by arcs is not tried after it has failed. Larger: it is tried again later where it holds. Smaller: it
/// fails more often.
const LONGEST_PAUSE: u32 = 64;

/// A point outside of an object and its gap: a disc without solid.
type Disc = (f64, f64, f64);

/// Whether a point is in a disc.
fn holds((x, y, gap): &Disc, point: (f64, f64)) -> bool {
    (point.0 - x).powi(2) + (point.1 - y).powi(2) < gap * gap
}

/// Proves gaps, with what it learned in earlier states.
#[derive(Debug, Default)]
pub(crate) struct Prover {
    /// Of the runs that have been near.
    lines: Vec<Lines>,
    /// Where among them each run is, counted from 1; 0 where it is not. Memory that is zero costs nothing until it is written: there may
    /// be a million runs.
    place: Vec<usize>,
    /// Of each object.
    outside: Vec<SmallVec<[Disc; DISCS]>>,
    /// Which of an object's discs is replaced next.
    next: usize,
    /// The run that a free rod was nearest to, and where.
    closest: Option<(usize, f64)>,
    /// For how many states the proof by arcs, which has failed, is not tried; and for how many it was not tried last.
    pause: u32,
    last_pause: u32,
    /// Runs and the intervals (first, last) that are near them.
    near: Vec<(usize, usize, usize)>,
    /// Objects, the intervals of the rod that may touch them, and the run if what cleared an interval of it does not tell the side.
    gates: Vec<(usize, usize, Option<usize>)>,
}

/// What a proof came to.
#[derive(Debug)]
pub(crate) struct Proof {
    /// Lower bound of the smallest gap; minus infinity where there is a crossing.
    pub lower: f64,
    /// The smallest gap that was seen.
    pub seen: f64,
    pub crossings: SmallVec<[Crossing; 2]>,
    /// The clamp itself is inside the solid.
    pub clamp_inside: bool,
}

impl Prover {
    /// Looks at the rod of `configuration`, whose `shape` is known. Points of it no deeper than `depth` (L) count as outside.
    pub fn prove(
        &mut self,
        rod: &impl RodModel,
        world: &World<'_>,
        configuration: &Configuration,
        shape: &Shape,
        depth: f64,
    ) -> Proof {
        let free = configuration.count() == 0;
        let mut search = Search::new(self, rod, world, Some(configuration), shape, depth);
        if free {
            search.proof.seen = search.nearest();
        }
        search.all();
        let (least, refuted) = (search.least(), !search.refuted.is_empty());
        let mut proof = search.proof;
        proof.lower = proof.lower.min(if free { least } else { 0.0 });
        if refuted || proof.clamp_inside {
            proof.lower = f64::NEG_INFINITY;
        }
        proof
    }

    /// A lower bound of the gap of the rod of `configuration`, if its arcs prove that it is outside of all objects but for its contacts. Of a free
    /// rod this proves too little. The `shape` needs no points.
    pub fn prove_by_arcs(
        &mut self,
        rod: &impl RodModel,
        world: &World<'_>,
        configuration: &Configuration,
        shape: &Shape,
    ) -> Option<f64> {
        if configuration.count() == 0 {
            return None;
        }
        if self.pause > 0 {
            self.pause -= 1;
            return None;
        }
        let proven = Search::new(self, rod, world, Some(configuration), shape, GAP_TOLERANCE).by_arcs();
        // where it fails it fails for many states: a rod between many contacts has too many inflections
        self.last_pause = if proven.is_some() { 0 } else { (2 * self.last_pause).clamp(1, LONGEST_PAUSE) };
        self.pause = self.last_pause;
        proven
    }

    /// Whether the straight way between two points goes through an object, runs that `skip` names left out.
    pub fn is_crossed(
        &mut self,
        world: &World<'_>,
        (from, to): ((f64, f64), (f64, f64)),
        skip: impl Fn(usize) -> bool,
    ) -> bool {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        if length <= 0.0 || length.is_nan() {
            return false;
        }
        self.outside.resize_with(world.objects(), SmallVec::new);
        // a disc without solid that holds both ends holds the way
        let both = |disc: &Disc| holds(disc, from) && holds(disc, to);
        if world.is_small() && self.outside.iter().all(|discs| discs.iter().any(both)) {
            return false;
        }
        self.gates.clear();
        let shape = Shape::straight(from, dy.atan2(dx), length);
        let part = interval(&Uniform, &shape, 0);
        let mut near: SmallVec<[usize; CROWD]> = SmallVec::new();
        world.runs_near(part.bounds(0.0), |run| near.push(run));
        let mut search = Search::new(self, &Uniform, world, None, &shape, GAP_TOLERANCE);
        near.into_iter().filter(|run| !skip(*run)).any(|run| {
            search.take(run);
            search.clear(0, &part);
            !search.refuted.is_empty()
        })
    }
}

struct Search<'a, M> {
    rod: &'a M,
    world: &'a World<'a>,
    /// The rod's contacts; none where what is looked at is no rod but the way of a point.
    configuration: Option<&'a Configuration>,
    shape: &'a Shape,
    /// Depth (L) down to which a point counts as outside.
    depth: f64,
    known: &'a mut Prover,
    proof: Proof,
    /// The run that is looked at, its object, and where its lines are kept.
    run: usize,
    object: usize,
    place: usize,
    /// Runs that the rod goes through.
    refuted: SmallVec<[usize; 2]>,
    /// Parts of intervals that were looked at one by one.
    looks: usize,
}

impl<'a, M: RodModel> Search<'a, M> {
    fn new(
        known: &'a mut Prover,
        rod: &'a M,
        world: &'a World<'a>,
        configuration: Option<&'a Configuration>,
        shape: &'a Shape,
        depth: f64,
    ) -> Self {
        if known.place.len() != world.runs() {
            known.lines.clear();
            known.place = vec![0; world.runs()];
        }
        known.outside.resize_with(world.objects(), SmallVec::new);
        // where there is a contact, there the gap is zero
        let proof = Proof { lower: f64::INFINITY, seen: 0.0, crossings: SmallVec::new(), clamp_inside: false };
        let refuted = SmallVec::new();
        Self { rod, world, configuration, shape, depth, known, proof, run: 0, object: 0, place: 0, refuted, looks: 0 }
    }

    /// Whether it is a rod without contacts.
    fn is_free(&self) -> bool {
        self.configuration.is_some_and(|configuration| configuration.count() == 0)
    }

    /// The gap that must be proven: of a free rod nearly all that was seen, so that the bound is of use.
    fn least(&self) -> f64 {
        if !self.is_free() || self.proof.seen < NEARLY_CLOSED {
            return -PROVEN * self.depth;
        }
        ((1.0 - BESIDE) * self.proof.seen).min(f64::MAX)
    }

    /// A gap of the rod that is not far from the smallest one: at the point where that was seen last, else of a few points.
    fn nearest(&mut self) -> f64 {
        if let Some((run, s)) = self.known.closest {
            let segments = &self.shape.segments;
            let knot = Knot::on(self.rod, &segments[segments.len() - 1], s);
            return self.world.run_foot(run, knot.at.x, knot.at.y).foot.gap.abs();
        }
        // behind an open contour a rod that came around its end is outside all the same
        let gap = |node: &Node| (self.world.gap(node.at.x, node.at.y).abs(), *node);
        let (least, Node { s, at, .. }) = self.shape.nodes[1..]
            .iter()
            .map(gap)
            .fold(gap(&self.shape.nodes[0]), |least, here| if here.0 < least.0 { here } else { least });
        if self.world.objects() == 1 {
            self.known.closest = Some((self.world.run_at(0, at.x, at.y), s));
        }
        least
    }

    fn all(&mut self) {
        let (world, last) = (self.world, self.shape.nodes.len() - 1);
        let mut near = std::mem::take(&mut self.known.near);
        near.clear();
        self.known.gates.clear();
        let mut crowded: SmallVec<[usize; 8]> = SmallVec::new();
        if world.is_small() {
            near.extend((0..world.runs()).map(|run| (run, 0, last)));
        } else {
            self.list_near(&mut near, &mut crowded);
        }
        for &(run, first, last) in &near {
            self.take(run);
            self.along(first, last);
        }
        for interval in crowded {
            self.in_crowd(interval);
        }
        self.known.near = near;
        self.clamp(&self.point(0, 0.0));
        if self.proof.crossings.is_empty() {
            self.sides();
        }
    }

    /// Turns to a run.
    fn take(&mut self, run: usize) {
        let Prover { lines, place, .. } = &mut *self.known;
        if place[run] == 0 {
            lines.push(Lines::default());
            place[run] = lines.len();
        }
        self.place = place[run] - 1;
        (self.run, self.object) = (run, self.world.object_of_run(run));
    }

    /// What is known of the run.
    fn lines(&mut self) -> &mut Lines {
        &mut self.known.lines[self.place]
    }

    /// The run.
    fn run(&mut self) -> &Run {
        let (world, run) = (self.world, self.run);
        self.lines().run.get_or_insert_with(|| world.run(run))
    }

    /// Lists the runs near each interval, and the intervals near too many.
    fn list_near(&self, near: &mut Vec<(usize, usize, usize)>, crowded: &mut SmallVec<[usize; 8]>) {
        let reach = self.least().max(0.0);
        for i in 0..self.shape.nodes.len() - 1 {
            let (interval, before) = (interval(self.rod, self.shape, i), near.len());
            self.world.runs_near(interval.bounds(reach), |run| {
                if near.len() - before <= CROWD && !interval.misses(&self.world.run_bounds(run), reach) {
                    near.push((run, i, i + 1));
                }
            });
            if near.len() - before > CROWD {
                near.truncate(before);
                crowded.push(i);
            }
        }
        near.sort_unstable();
        near.dedup_by(|next, kept| {
            let goes_on = next.0 == kept.0 && next.1 == kept.2;
            if goes_on {
                kept.2 = next.2;
            }
            goes_on
        });
    }

    /// Clears the intervals between two nodes of the run.
    fn along(&mut self, first: usize, last: usize) {
        let box_of_run = self.run().bounds;
        let touches = self.touches(first, last);
        let mut i = first;
        while i < last {
            let (least, nodes) = (self.least(), &self.shape.nodes[i..=last]);
            let beyond =
                nodes.windows(2).take_while(|pair| pair[0].is_beyond(&pair[1], &box_of_run, least.max(0.0))).count();
            if beyond > 0 {
                self.proof.lower = self.proof.lower.min(least.max(GATE));
                i += beyond;
                continue;
            }
            if let Some(count) = self.beside_touch(&touches, i, last) {
                i += count;
                continue;
            }
            let Prover { lines, gates, .. } = &mut *self.known;
            let (object, run, place) = (self.object, self.run, self.place);
            let (rod, shape) = (self.rod, self.shape);
            let touch = |k: usize, line: &Line| gates.push((object, i + k, (!line.outward).then_some(run)));
            let limits = (least, GATE.max(least));
            let tangents = touches.iter().filter_map(|touch| touch.tangent.as_ref());
            if let Some((count, bound)) =
                lines[place].clear(nodes, |k| interval(rod, shape, i + k), limits, tangents, touch)
            {
                self.proof.lower = self.proof.lower.min(bound);
                i += count;
                continue;
            }
            self.clear(i, &interval(self.rod, self.shape, i));
            i += 1;
        }
    }

    /// Clears an interval of the runs near it, halving it where short ones are many.
    fn in_crowd(&mut self, i: usize) {
        let mut parts = vec![interval(self.rod, self.shape, i)];
        while let Some(part) = parts.pop() {
            let reach = self.least().max(0.0);
            let (mut near, mut short): (SmallVec<[usize; CROWD]>, usize) = (SmallVec::new(), 0);
            // below the reach itself no part meets fewer of them
            let may_halve = part.length > SHORTEST.max(0.1 * reach);
            self.world.runs_near(part.bounds(reach), |run| {
                let bounds = self.world.run_bounds(run);
                if (short <= CROWD || !may_halve) && !part.misses(&bounds, reach) {
                    near.push(run);
                    let sides = [0, 1].map(|axis| bounds.max[axis] - bounds.min[axis]);
                    short += usize::from(sides[0].max(sides[1]) < part.length);
                }
            });
            if short > CROWD && may_halve {
                parts.extend(part.split(self.rod, &self.shape.segments[part.segment], 0.5 * (part.from.s + part.to.s)));
                continue;
            }
            for run in near {
                self.take(run);
                self.clear(i, &part);
            }
        }
    }

    /// Notes that interval `i`, or a part of it, has at least a gap of `bound` to the run.
    fn note(&mut self, i: usize, bound: f64, unsigned: bool) {
        self.proof.lower = self.proof.lower.min(bound);
        if bound <= GATE {
            self.known.gates.push((self.object, i, unsigned.then_some(self.run)));
        }
    }

    /// Clears a part of interval `i` of the run, halving it where that is needed, or finds where it goes through.
    fn clear(&mut self, i: usize, part: &Interval) {
        let Some(s) = self.clear_at_once(i, part) else { return };
        let mut parts = part.split(self.rod, &self.shape.segments[part.segment], s).to_vec();
        parts.reverse();
        while let Some(part) = parts.pop() {
            self.looks += 1;
            if self.looks > MOST_LOOKS {
                self.proof.lower = f64::NEG_INFINITY;
                return;
            }
            if let Some(s) = self.clear_at_once(i, &part) {
                let [before, after] = part.split(self.rod, &self.shape.segments[part.segment], s);
                parts.push(after);
                parts.push(before);
            }
        }
    }

    /// The same without halving: where to halve it, if that is needed.
    fn clear_at_once(&mut self, i: usize, part: &Interval) -> Option<f64> {
        let least = self.least();
        if let Some((bound, line)) = self.lines().clear_interval(part, least) {
            self.note(i, bound, !line.outward);
            return None;
        }
        let run = *self.run();
        if part.misses(&run.bounds, least.max(0.0)) {
            self.note(i, least.max(GATE), false);
            return None;
        }
        let feet = [self.foot(&part.from), self.foot(&part.to)];
        for (knot, foot) in [(&part.from, &feet[0]), (&part.to, &feet[1])] {
            if foot.end.is_none() && foot.foot.gap < -self.depth && self.is_inside(knot) {
                self.refute(knot);
                return None;
            }
            if foot.foot.gap.abs() < self.proof.seen {
                self.proof.seen = foot.foot.gap.abs();
                self.known.closest = Some((self.run, knot.s));
            }
        }
        // a shape that has no closest point proves nothing
        if !feet.iter().all(|foot| foot.foot.gap.is_finite()) {
            self.proof.lower = f64::NEG_INFINITY;
            return None;
        }
        let least = self.least();
        let mut found = None;
        for (foot, knot) in feet.iter().zip([&part.from, &part.to]) {
            self.candidates(&run, foot, knot, part.length, |line| {
                let bound = line.bound(part);
                let clears = bound > least;
                if clears {
                    found = Some((line, bound));
                }
                clears
            });
            if let Some((line, bound)) = found {
                self.lines().keep(line);
                self.note(i, bound, !line.outward);
                return None;
            }
        }
        for (foot, forward) in [(&feet[0], true), (&feet[1], false)] {
            if let Some(bound) = self.compare_on_tangent(&run, foot, part, forward).filter(|bound| *bound > least) {
                self.note(i, bound, false);
                return None;
            }
        }
        if let Some(bound) = self.concave(&run, &feet, part).filter(|bound| *bound > least) {
            self.note(i, bound, false);
            return None;
        }
        let [g0, g1] = feet.map(|foot| foot.foot.gap);
        let bound = 0.5 * (g0.abs() + g1.abs() - part.length);
        // A rod straight through the run has its ends on either side, as far away as it is long.
        let through = (g0 < 0.0) != (g1 < 0.0) && feet.iter().all(|foot| foot.end.is_none()) && bound <= GATE;
        let shortest = SHORTEST.max(COARSE * least);
        if (bound > least && !through) || part.length < shortest {
            self.note(i, bound, true);
            return None;
        }
        Some(lowest(part, &feet))
    }

    fn foot(&self, knot: &Knot) -> RunFoot {
        self.world.run_foot(self.run, knot.at.x, knot.at.y)
    }

    /// Whether a point behind the run is inside the object: it may be outside, behind another part.
    fn is_inside(&self, Knot { at, .. }: &Knot) -> bool {
        self.world.is_inside(self.object, at.x, at.y, self.depth)
    }

    /// Notes that a point is inside the object: the rod goes through the run that is nearest there.
    fn refute(&mut self, knot: &Knot) {
        let run = self.world.run_at(self.object, knot.at.x, knot.at.y);
        if self.refuted.contains(&run) {
            return;
        }
        self.refuted.push(run);
        let Some(configuration) = self.configuration else { return };
        let crossing = Rod { model: self.rod, world: self.world, shape: self.shape }.touch(run, knot);
        self.proof.seen = self.proof.seen.min(crossing.foot.gap);
        if !(crossing.tip && configuration.ends_at_tip()) {
            self.proof.crossings.push(crossing);
        }
    }
}

/// The rod between node `i` and the next one.
fn interval(rod: &impl RodModel, shape: &Shape, i: usize) -> Interval {
    let [from, to] = [&shape.nodes[i], &shape.nodes[i + 1]];
    Interval::new(rod, Knot::from(from), Knot::from(to), from.segment, shape.force(from.segment))
}

/// How fast the rod runs in a direction.
fn rate(Knot { at, .. }: &Knot, (x, y): (f64, f64)) -> f64 {
    x * at.cos + y * at.sin
}

/// Where to halve an interval: about where the gap is least, as its slopes at the ends tell. A rod that grazes the contour
/// there is clear on both sides, compared with the contour from that point on.
fn lowest(part: &Interval, feet: &[RunFoot; 2]) -> f64 {
    let [d0, d1] = [(&part.from, &feet[0].foot), (&part.to, &feet[1].foot)]
        .map(|(knot, foot)| rate(knot, foot.uphill(knot.at.x, knot.at.y)));
    let share = if d0 < 0.0 && d1 > 0.0 { d0 / (d0 - d1) } else { 0.5 };
    part.from.s + share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE) * part.length
}
