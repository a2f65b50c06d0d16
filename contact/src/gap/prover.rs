//! A proof that the rod stays outside of the objects, or the places where it does not.
//!
//! The rod is cut into intervals, the contours into [runs](rod_contours::Run) that bend one way. An interval is clear of a
//! run where a line separates the two (one that is known from an earlier interval or state, mostly), where the rod leaves a
//! point at which it is parallel to the run with less bend than the run has, or where both ends are farther away than it is
//! long; else it is halved. What no run is met by stays on one side of the contour, so that a few signed distances tell
//! which: at the clamp, and behind each interval that the contour may have been touched in.

use super::interval::{Interval, Knot};
use super::separator::{Line, Lines};
use super::touch::Rod;
use super::{Crossing, GAP_TOLERANCE};
use crate::configuration::Configuration;
use crate::shape::Shape;
use crate::world::{AHEAD, RunFoot, World};
use rod_contours::{Bend, Bounds, Run};
use rod_core::Hold;
use smallvec::SmallVec;

/// Length of an interval that is not halved any more, in lengths of the rod: its points are no deeper than half of it.
const SHORTEST: f64 = 1e-12;
/// Depth (L) to which the rod is proven not to be in a contour. Ten times that at which it is called inside: the room between
/// the two is what an interval next to a flat contact needs to be cleared without being cut to pieces.
const PROVEN: f64 = 1e-11;
/// Sine of the angle between rod and contour below which they count as parallel.
const PARALLEL: f64 = 1e-9;
/// Largest turn of the rod and of the contour over an interval along which they are compared, rad.
const LARGEST_TURN: f64 = 0.5;
/// Room for rounding in the curvatures that are compared, in units of 1 / L.
const SLACK: f64 = 1e-9;
/// An interval with a bound below this may touch the contour, and what follows may be on its other side.
const GATE: f64 = 1e-12;
/// An interval that meets the boxes of more runs than this is halved first.
const CROWD: usize = 12;
/// Of a free rod, how much smaller the proven gap may be than the smallest one seen, as a share of that.
const BESIDE: f64 = 1e-3;
/// Length of an interval of a free rod that is not halved any more, as a share of the gap.
const COARSE: f64 = 1e-3;
/// Gap of a free rod below which only that it is not closed is proven.
const NEARLY_CLOSED: f64 = 1e-9;
/// Most intervals that are compared with the contour at once.
const AT_ONCE: usize = 6;
/// Discs without solid that are kept of one object.
const DISCS: usize = 4;
/// Least share of an interval that is cut off.
const LEAST_SHARE: f64 = 0.1;
/// Most parts of intervals that are looked at one by one; a state takes some tens. Beyond that nothing is proven.
const MOST_LOOKS: usize = 100_000;
/// Closer to a vertex than this the direction to it is rounding.
const AT_VERTEX: f64 = 1e-6;

/// Proves gaps, with what it learned in earlier states.
#[derive(Debug, Default)]
pub(crate) struct Prover {
    /// Of each run.
    lines: Vec<Lines>,
    /// Of each object: points outside of it, and their gaps.
    outside: Vec<SmallVec<[(f64, f64, f64); DISCS]>>,
    /// Which of an object's discs is replaced next.
    next: usize,
    /// The run that a free rod was nearest to, and where.
    closest: Option<(usize, f64)>,
    /// Runs and the intervals (first, last) that are near them.
    near: Vec<(usize, usize, usize)>,
    /// Objects and the intervals of the rod that may touch them, and whether what cleared one does not tell the side.
    gates: Vec<(usize, usize, bool)>,
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
    /// Looks at the rod of `configuration`, whose `shape` is known.
    pub fn prove(&mut self, world: &World<'_>, configuration: &Configuration, shape: &Shape) -> Proof {
        let free = configuration.count() == 0;
        let mut search = Search::new(self, world, Some(configuration), shape);
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
        let holds = |(x, y, gap): &(f64, f64, f64)| {
            [from, to].iter().all(|end| (end.0 - x).powi(2) + (end.1 - y).powi(2) < gap * gap)
        };
        if world.is_small() && self.outside.iter().all(|discs| discs.iter().any(holds)) {
            return false;
        }
        self.gates.clear();
        let shape = Shape::straight(from, dy.atan2(dx), length);
        let part = interval(&shape, 0);
        let mut near: SmallVec<[usize; CROWD]> = SmallVec::new();
        world.runs_near(part.bounds(0.0), |run| near.push(run));
        let mut search = Search::new(self, world, None, &shape);
        near.into_iter().filter(|run| !skip(*run)).any(|run| {
            search.take(run);
            search.clear(0, &part);
            !search.refuted.is_empty()
        })
    }
}

struct Search<'a> {
    world: &'a World<'a>,
    /// The rod's contacts; none where what is looked at is no rod but the way of a point.
    configuration: Option<&'a Configuration>,
    shape: &'a Shape,
    known: &'a mut Prover,
    proof: Proof,
    /// The run that is looked at, and its object.
    run: usize,
    object: usize,
    /// Runs that the rod goes through.
    refuted: SmallVec<[usize; 2]>,
    /// Parts of intervals that were looked at one by one.
    looks: usize,
}

impl<'a> Search<'a> {
    fn new(
        known: &'a mut Prover,
        world: &'a World<'a>,
        configuration: Option<&'a Configuration>,
        shape: &'a Shape,
    ) -> Self {
        known.lines.resize_with(world.runs(), Lines::default);
        known.outside.resize_with(world.objects(), SmallVec::new);
        // where there is a contact, there the gap is zero
        let proof = Proof { lower: f64::INFINITY, seen: 0.0, crossings: SmallVec::new(), clamp_inside: false };
        Self { world, configuration, shape, known, proof, run: 0, object: 0, refuted: SmallVec::new(), looks: 0 }
    }

    /// Whether it is a rod without contacts.
    fn is_free(&self) -> bool {
        self.configuration.is_some_and(|configuration| configuration.count() == 0)
    }

    /// The gap that must be proven: of a free rod nearly all that was seen, so that the bound is of use.
    fn least(&self) -> f64 {
        if !self.is_free() || self.proof.seen < NEARLY_CLOSED {
            return -PROVEN;
        }
        ((1.0 - BESIDE) * self.proof.seen).min(f64::MAX)
    }

    /// A gap of the rod that is not far from the smallest one: at the point where that was seen last, else of a few points.
    fn nearest(&self) -> f64 {
        if let Some((run, s)) = self.known.closest {
            let spans = &self.shape.spans;
            let knot = Knot::on(&spans[spans.len() - 1], s);
            return self.world.run_foot(run, knot.at.x, knot.at.y).foot.gap.abs();
        }
        self.shape.nodes.iter().map(|node| self.world.gap(node.at.x, node.at.y)).fold(f64::INFINITY, f64::min)
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
        self.clamp();
        if self.proof.crossings.is_empty() {
            self.sides();
        }
    }

    /// Turns to a run.
    fn take(&mut self, run: usize) {
        (self.run, self.object) = (run, self.world.object_of_run(run));
    }

    /// Lists the runs near each interval, and the intervals near too many.
    fn list_near(&self, near: &mut Vec<(usize, usize, usize)>, crowded: &mut SmallVec<[usize; 8]>) {
        let reach = self.least().max(0.0);
        for i in 0..self.shape.nodes.len() - 1 {
            let (interval, before) = (interval(self.shape, i), near.len());
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
        let world = self.world;
        let box_of_run = self.known.lines[self.run].run.get_or_insert_with(|| world.run(self.run)).bounds;
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
            let Prover { lines, gates, .. } = &mut *self.known;
            let (object, shape) = (self.object, self.shape);
            let touch = |k: usize, line: &Line| gates.push((object, i + k, !line.outward));
            let limits = (least, GATE.max(least));
            if let Some((count, bound)) = lines[self.run].clear(nodes, |k| interval(shape, i + k), limits, touch) {
                self.proof.lower = self.proof.lower.min(bound);
                i += count;
                continue;
            }
            if let Some(count) = self.beside_contact(i, last) {
                i += count;
                continue;
            }
            self.clear(i, &interval(self.shape, i));
            i += 1;
        }
    }

    /// Clears an interval of the runs near it, halving it where they are many.
    fn in_crowd(&mut self, i: usize) {
        let mut parts = vec![interval(self.shape, i)];
        while let Some(part) = parts.pop() {
            let reach = self.least().max(0.0);
            let mut near: SmallVec<[usize; CROWD]> = SmallVec::new();
            // below the reach itself no part meets fewer of them
            let halve = part.length > SHORTEST.max(0.1 * reach);
            self.world.runs_near(part.bounds(reach), |run| {
                if (near.len() <= CROWD || !halve) && !part.misses(&self.world.run_bounds(run), reach) {
                    near.push(run);
                }
            });
            if near.len() > CROWD && halve {
                parts.extend(part.split(&self.shape.spans[part.span], 0.5 * (part.from.s + part.to.s)));
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
            self.known.gates.push((self.object, i, unsigned));
        }
    }

    /// Clears a part of interval `i` of the run, halving it where that is needed, or finds where it goes through.
    fn clear(&mut self, i: usize, part: &Interval) {
        let Some(s) = self.clear_at_once(i, part) else { return };
        let mut parts = part.split(&self.shape.spans[part.span], s).to_vec();
        parts.reverse();
        while let Some(part) = parts.pop() {
            self.looks += 1;
            if self.looks > MOST_LOOKS {
                self.proof.lower = f64::NEG_INFINITY;
                return;
            }
            if let Some(s) = self.clear_at_once(i, &part) {
                let [before, after] = part.split(&self.shape.spans[part.span], s);
                parts.push(after);
                parts.push(before);
            }
        }
    }

    /// The same without halving: where to halve it, if that is needed.
    fn clear_at_once(&mut self, i: usize, part: &Interval) -> Option<f64> {
        let least = self.least();
        if let Some((bound, line)) = self.known.lines[self.run].clear_interval(part, least) {
            self.note(i, bound, !line.outward);
            return None;
        }
        let run = *self.known.lines[self.run].run.get_or_insert_with(|| self.world.run(self.run));
        if part.misses(&run.bounds, least.max(0.0)) {
            self.note(i, least.max(GATE), false);
            return None;
        }
        let feet = [self.foot(&part.from), self.foot(&part.to)];
        for (knot, foot) in [(&part.from, &feet[0]), (&part.to, &feet[1])] {
            if foot.end.is_none() && foot.foot.gap < -GAP_TOLERANCE && self.is_inside(knot) {
                self.refute(knot);
                return None;
            }
            if foot.foot.gap.abs() < self.proof.seen {
                self.proof.seen = foot.foot.gap.abs();
                self.known.closest = Some((self.run, knot.s));
            }
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
                self.known.lines[self.run].keep(line);
                self.note(i, bound, !line.outward);
                return None;
            }
        }
        for (foot, forward) in [(&feet[0], true), (&feet[1], false)] {
            if let Some(bound) = self.compared(&run, foot, part, forward).filter(|bound| *bound > least) {
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
        let shortest = SHORTEST.max(COARSE * least);
        if bound > least || part.length < shortest {
            self.note(i, bound, true);
            return None;
        }
        Some(lowest(part, &feet))
    }

    fn foot(&self, knot: &Knot) -> RunFoot {
        self.world.run_foot(self.run, knot.at.x, knot.at.y)
    }

    /// How many intervals from number `i` on, up to number `last`, next to a contact with the run, are clear of it.
    fn beside_contact(&mut self, i: usize, last: usize) -> Option<usize> {
        let (j, forward) = match (self.shape.contact_at(i), self.shape.contact_at(i + 1)) {
            (Some(j), _) => (j, true),
            (_, Some(j)) => (j, false),
            _ => return None,
        };
        let configuration = self.configuration?;
        let (contact, t) = (configuration.contacts[j], configuration.t(j));
        if contact.hold == Hold::Tip || !self.world.is_on_run(self.run, contact.stretch, t) {
            return None;
        }
        let span = self.shape.nodes[i].span;
        // as many intervals as there may be, then one alone
        let most = if forward { AT_ONCE.min(self.shape.last_of(span).min(last) - i) } else { 1 };
        [most, 1].into_iter().take(if most > 1 { 2 } else { 1 }).find_map(|count| {
            let [from, to] = [i, i + count].map(|k| Knot::from(&self.shape.nodes[k]));
            let part = Interval::new(from, to, span, self.shape.force(span));
            let at = if forward { &from.at } else { &to.at };
            let foot = self.world.touched(contact.stretch, t, at.x, at.y);
            let run = *self.known.lines[self.run].run.get_or_insert_with(|| self.world.run(self.run));
            let foot =
                RunFoot { foot, stretch: contact.stretch, end: None, joint: self.world.is_corner(contact.stretch) };
            let bound = self.compared(&run, &foot, &part, forward).filter(|bound| *bound > self.least())?;
            self.note(if forward { i } else { i + count - 1 }, bound, false);
            Some(count)
        })
    }

    /// Whether a point behind the run is inside the object: it may be outside, behind another part.
    fn is_inside(&self, Knot { at, .. }: &Knot) -> bool {
        self.world.is_inside(self.object, at.x, at.y, GAP_TOLERANCE)
    }

    /// Notes that a point is inside the object: the rod goes through the run that is nearest there.
    fn refute(&mut self, knot: &Knot) {
        let run = self.world.run_at(self.object, knot.at.x, knot.at.y);
        if self.refuted.contains(&run) {
            return;
        }
        self.refuted.push(run);
        let Some(configuration) = self.configuration else { return };
        let crossing = Rod { world: self.world, shape: self.shape }.touch(run, knot);
        self.proof.clamp_inside |= crossing.s <= 0.0;
        self.proof.seen = self.proof.seen.min(crossing.foot.gap);
        if !(crossing.tip && configuration.ends_at_tip()) {
            self.proof.crossings.push(crossing);
        }
    }

    /// Hands out lines that keep the run behind them, as its closest point `foot` to an end of the interval suggests them,
    /// until one is taken.
    fn candidates(
        &self,
        run: &Run,
        RunFoot { foot, stretch, end, joint }: &RunFoot,
        Knot { at, .. }: &Knot,
        length: f64,
        mut take: impl FnMut(Line) -> bool,
    ) {
        let line = |at: (f64, f64), normal: (f64, f64), outward: bool| Line { at, normal, outward };
        let ends = run.ends;
        let outward = run.bend == Bend::Outward;
        if outward && end.is_none() {
            if foot.gap >= -GAP_TOLERANCE {
                let away = (at.x - foot.x).hypot(at.y - foot.y);
                let normal = if *joint && away < AT_VERTEX { foot.normal() } else { foot.uphill(at.x, at.y) };
                if take(line((foot.x, foot.y), normal, true)) {
                    return;
                }
                // at a vertex both its edges hold the run
                let edges = joint.then(|| self.world.joint_normals(*stretch));
                if edges.into_iter().flatten().any(|normal| take(line((foot.x, foot.y), normal, true))) {
                    return;
                }
            } else if let [Some(from), Some(to)] = &ends
                && from.into[0] * to.into[0] + from.into[1] * to.into[1] < -1.0 + f64::EPSILON
                && take(line((foot.x, foot.y), (-from.normal[0], -from.normal[1]), false))
            {
                return;
            }
        }
        // the chord, with the run on the side it bends to
        if let [Some(from), Some(to)] = &ends
            && run.bend != Bend::Mixed
        {
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            let chord = dx.hypot(dy);
            let side = if outward { -1.0 } else { 1.0 };
            if chord > 0.0 && take(line((from.x, from.y), (side * dy / chord, -side * dx / chord), !outward)) {
                return;
            }
        }
        for number in 0..2 {
            let Some(corner) = ends[number] else { continue };
            let (dx, dy) = (at.x - corner.x, at.y - corner.y);
            let away = dx.hypot(dy);
            if *end != Some(number) && away > 2.0 * length {
                continue;
            }
            let turn = if run.bend == Bend::Mixed { self.turn() } else { 0.0 };
            if turn > LARGEST_TURN {
                continue;
            }
            let holds = |(ux, uy): (f64, f64)| {
                let along = ux * corner.into[0] + uy * corner.into[1];
                // the chord bounds the run's directions on the other side
                let chord = ends[1 - number].map(|other| (other.x - corner.x, other.y - corner.y));
                let chord = chord.or(run.far[1 - number].map(|[x, y]| (x, y)));
                along <= f64::EPSILON - turn
                    && (turn > 0.0 || chord.is_some_and(|(x, y)| ux * x + uy * y <= f64::EPSILON))
            };
            let normal = (corner.normal[0], corner.normal[1]);
            if outward && take(line((corner.x, corner.y), normal, true)) {
                return;
            }
            let aim = if away > AT_VERTEX { (dx / away, dy / away) } else { normal };
            let (tangent, across) = ((at.cos, at.sin), (-at.sin, at.cos));
            let minus = |(x, y): (f64, f64)| (-x, -y);
            for normal in [aim, across, minus(across), tangent, minus(tangent)] {
                if holds(normal) && take(line((corner.x, corner.y), normal, false)) {
                    return;
                }
            }
        }
    }

    /// Largest angle between two tangents of the run, as its box and its curvature allow.
    fn turn(&self) -> f64 {
        let (least, largest) = self.world.run_curvature(self.run);
        let Bounds { min, max } = self.world.run_bounds(self.run);
        // an arc that turns by half a radian is longer than its chord by less than a tenth
        1.1 * (max[0] - min[0]).hypot(max[1] - min[1]) * largest.max(-least)
    }

    /// Lower bound of the gap along an interval that begins (or, where it does not go `forward`, ends) where the rod is
    /// parallel to the contour. There both are graphs over the common tangent, with d(sin theta)/dx = curvature: while the rod
    /// bends towards the solid by no more than the contour does, slopes and heights stay in order.
    fn compared(
        &self,
        run: &Run,
        RunFoot { foot, stretch, end, joint }: &RunFoot,
        part: &Interval,
        forward: bool,
    ) -> Option<f64> {
        let knot = if forward { &part.from } else { &part.to };
        let (sin, cos) = foot.alpha.sin_cos();
        let slope = knot.at.cos * sin - knot.at.sin * cos;
        if slope.abs() > PARALLEL || *joint || end.is_some() && foot.gap.abs() > PARALLEL {
            return None;
        }
        let along = knot.at.cos * cos + knot.at.sin * sin;
        let sense = along.signum();
        let bend = (sense * part.curvature.0).max(sense * part.curvature.1);
        if part.bent * part.length > LARGEST_TURN {
            return None;
        }
        let ahead = if forward { sense } else { -sense };
        let outward = run.bend == Bend::Outward;
        let least = self.world.curvature_ahead(outward, *stretch, foot.t, ahead, part.length, LARGEST_TURN)?;
        let height = foot.gap - AHEAD * part.length * slope.abs();
        (bend <= least + SLACK).then_some(height - SLACK * part.length * part.length)
    }

    /// Lower bound of the gap between two feet on a run that bends inwards somewhere: g'' >= -k - q / (1 - q g), where the
    /// rod's curvature is at most k and the run's at most q away from the solid. As long as q g < 1 the foot of an arc that
    /// turns by no more than a right angle moves without a jump.
    fn concave(&self, run: &Run, [from, to]: &[RunFoot; 2], part: &Interval) -> Option<f64> {
        let (g0, g1) = (from.foot.gap, to.foot.gap);
        if run.bend == Bend::Outward || from.end.is_some() || to.end.is_some() || g0.min(g1) < -GAP_TOLERANCE {
            return None;
        }
        let sharpest = (-self.world.run_curvature(self.run).0).max(0.0);
        let highest = 0.5 * (g0 + g1 + part.length);
        let room = 1.0 - sharpest * highest;
        if !(room > 0.0 && sharpest.is_finite()) {
            return None;
        }
        let (d0, d1) = (rate(&part.from, from.foot.normal()), rate(&part.to, to.foot.normal()));
        Some(part.least((g0, d0), (g1, d1), -part.bent - sharpest / room))
    }

    /// Whether the clamp is inside an object.
    fn clamp(&mut self) {
        let Knot { at, .. } = self.point(0, 0.0);
        let world = self.world;
        world.objects_at(at.x, at.y, |object| {
            self.object = object;
            if !self.is_outside(0, 0.0) {
                self.proof.clamp_inside = true;
                self.proof.seen = self.proof.seen.min(world.object_gap(object, at.x, at.y));
            }
        });
    }

    /// Asks on which side of an object the rod is, where it may have touched it: in the middle of the stretch behind those
    /// intervals, at the tip where nothing is behind, and in an interval that is clear of the run, but on either side.
    fn sides(&mut self) {
        let mut gates = std::mem::take(&mut self.known.gates);
        gates.sort_unstable();
        let last = self.shape.nodes.len() - 1;
        let mut k = 0;
        while let Some(&(object, i, unsigned)) = gates.get(k) {
            k += 1;
            let next = gates.get(k).filter(|next| next.0 == object).map(|next| next.1);
            self.object = object;
            if self.world.is_one_convex(object) {
                continue;
            }
            let behind = match next {
                Some(next) if next <= i + 1 => None,
                next => Some(i + 1 + (next.unwrap_or(last) - i - 1) / 2),
            };
            let doubts = unsigned.then_some([(i, 0.5), (i + 1, 0.0)]);
            let asked = behind.map(|k| (k, 0.0)).into_iter().chain(doubts.into_iter().flatten());
            for (k, share) in asked {
                if !self.is_outside(k, share) {
                    let knot = self.point(k, share);
                    self.refute(&knot);
                }
            }
        }
        self.known.gates = gates;
    }

    /// The node `k`, or a point by a share of the way to the next one.
    fn point(&self, k: usize, share: f64) -> Knot {
        let node = &self.shape.nodes[k];
        if share == 0.0 {
            return Knot::from(node);
        }
        let s = node.s + share * (self.shape.nodes[k + 1].s - node.s);
        Knot::on(&self.shape.spans[node.span], s)
    }

    /// Whether a point of the rod is outside of the object: mostly it is in a disc that is known to be.
    fn is_outside(&mut self, k: usize, share: f64) -> bool {
        let (world, object) = (self.world, self.object);
        let Knot { at, .. } = self.point(k, share);
        if world.is_far_outside(object, at.x, at.y) {
            return true;
        }
        let discs = &mut self.known.outside[object];
        let within = |(x, y, gap): &(f64, f64, f64)| (at.x - x).powi(2) + (at.y - y).powi(2) < gap * gap;
        if discs.iter().any(within) {
            return true;
        }
        let gap = world.object_gap(object, at.x, at.y);
        if gap > 0.0 {
            let disc = (at.x, at.y, gap);
            if discs.len() < DISCS {
                discs.push(disc);
            } else {
                self.known.next = (self.known.next + 1) % DISCS;
                discs[self.known.next] = disc;
            }
        }
        !world.is_inside(object, at.x, at.y, GAP_TOLERANCE)
    }
}

/// The rod between node `i` and the next one.
fn interval(shape: &Shape, i: usize) -> Interval {
    let [from, to] = [&shape.nodes[i], &shape.nodes[i + 1]];
    Interval::new(Knot::from(from), Knot::from(to), from.span, shape.force(from.span))
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
