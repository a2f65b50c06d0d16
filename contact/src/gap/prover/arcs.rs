//! The proof by arcs, with few points of the rod between its contacts.
//!
//! A part of a segment whose curvature keeps its sign ([`one_bend`](rod_core::RodModel::one_bend)), and that turns by less than pi, is a convex
//! arc: it lies within the triangle of its chord and of the tangents at its ends. A line that keeps a run behind it and the corners of the
//! triangle in front of it separates the two. At a contact this is the tangent of a run that bends outwards: the rod is on the outer side
//! of the run there, and it stays there, because it meets no other run. A part that is no arc, or that no line separates, is cut in two.

use super::{CROWD, GATE, Search};
use crate::contact_set::ActiveContact;
use crate::gap::interval::{Interval, Knot};
use crate::gap::separator::Line;
use crate::scene::rod::{self, Segment};
use rod_contours::{Bend, Bounds};
use rod_core::{Cut, RodModel, Station};
use smallvec::{SmallVec, smallvec};
use std::cmp::Ordering;

/// Largest turn (rad) of an arc. Nearer to pi the tangents at its ends meet far away.
const LARGEST_TURN: f64 = 2.6;
/// Least turn (rad) of an arc whose tangents are made to meet. A smaller one leaves its chord by no more than a quarter of the turn times its
/// length.
const LEAST_TURN: f64 = 1e-6;
/// Error (L) across an end of an arc that the residual of a solve leaves. The point where the tangents meet moves along them by as much over the
/// sine of the turn.
const ACROSS: f64 = 1e-12;
/// Cuts of one rod at most. With more the proof by points costs less.
const MOST_CUTS: usize = 6;
/// Length (L) beside an inflection that is left out of the arcs on both sides: more than the error of its guess. What is left leaves its chord by
/// about the third power of this.
const BESIDE_INFLECTION: f64 = 0.02;
/// Share of a part that both its halves keep at least.
const LEAST_SHARE: f64 = 0.1;

/// A place of the rod: a cut, its direction, and the contact there, if it is one.
#[derive(Clone, Copy)]
struct Place {
    s: f64,
    cut: Cut,
    at: Station,
    contact: Option<usize>,
}

impl Place {
    fn new(s: f64, cut: Cut, contact: Option<usize>) -> Self {
        Self { s, cut, at: Station::from(&cut), contact }
    }

    fn knot(&self) -> Knot {
        Knot { s: self.s, at: self.at }
    }
}

/// A part of a segment.
struct Part<'a> {
    ends: [Place; 2],
    segment: &'a Segment,
    number: usize,
    hull: Hull,
}

/// What holds a part.
enum Hull {
    Arc(Arc),
    /// Of one that may bend both ways.
    Interval(Interval),
}

/// The triangle of an arc.
struct Arc {
    /// Ways from the start along its tangent, and from the end back along the tangent there, to the point where the two meet.
    ways: [f64; 2],
    /// Error of these ways.
    error: f64,
    /// How far the arc leaves its chord, if its tangents are not made to meet.
    sag: f64,
}

impl Arc {
    /// The arc between two places that bends in the sense of `bend`. None where it turns too far.
    fn new([from, to]: &[Place; 2], bend: f64) -> Option<Self> {
        let turn = to.cut.phi - from.cut.phi;
        let is_arc = turn.abs() < LARGEST_TURN && turn * bend >= -LEAST_TURN;
        if !is_arc || turn.abs() < LEAST_TURN {
            let sag = 0.25 * (to.s - from.s) * turn.abs();
            return is_arc.then_some(Self { ways: [0.0; 2], error: 0.0, sag });
        }
        let (start, end) = (&from.at, &to.at);
        let inverse = 1.0 / (start.cos * end.sin - start.sin * end.cos);
        let (dx, dy) = (end.x - start.x, end.y - start.y);
        let ways = [dx * end.sin - dy * end.cos, start.cos * dy - start.sin * dx].map(|area| area * inverse);
        Some(Self { ways, error: ACROSS * inverse.abs(), sag: 0.0 })
    }

    /// Lower bound of the distance of the arc between these ends in front of a line.
    fn least_height(&self, [from, to]: &[Place; 2], Line { at, normal, .. }: &Line) -> f64 {
        let height = |end: &Station| (end.x - at.0) * normal.0 + (end.y - at.1) * normal.1;
        let slope = |end: &Station| end.cos * normal.0 + end.sin * normal.1;
        let ends = [height(&from.at), height(&to.at)];
        let slopes = [slope(&from.at), slope(&to.at)];
        // by the end at which the tangent runs along the line more closely: there an error of the way counts less
        let apex = if slopes[0].abs() < slopes[1].abs() {
            ends[0] + self.ways[0] * slopes[0] - self.error * slopes[0].abs()
        } else {
            ends[1] - self.ways[1] * slopes[1] - self.error * slopes[1].abs()
        };
        ends[0].min(ends[1]).min(apex) - self.sag
    }
}

impl Part<'_> {
    fn least_height(&self, line: &Line) -> f64 {
        match &self.hull {
            Hull::Arc(arc) => arc.least_height(&self.ends, line),
            Hull::Interval(interval) => interval.least_height(line.at, line.normal),
        }
    }

    /// A box around it.
    fn bounds(&self) -> Bounds {
        match &self.hull {
            Hull::Arc(Arc { ways, error, sag }) => {
                let [Station { x, y, cos, sin, .. }, end] = [self.ends[0].at, self.ends[1].at];
                let apex = (x + ways[0] * cos, y + ways[0] * sin);
                Bounds::EMPTY.with(x, y).with(end.x, end.y).with(apex.0, apex.1).grown(error + sag)
            }
            Hull::Interval(interval) => interval.bounds(0.0),
        }
    }
}

/// Whether two boxes are farther than [`GATE`] from each other.
fn are_apart(one: &Bounds, other: &Bounds) -> bool {
    (0..2).any(|k| one.max[k] + GATE < other.min[k] || one.min[k] - GATE > other.max[k])
}

impl<M: RodModel> Search<'_, M> {
    /// A lower bound of the gap, where lines keep each run from each part of the rod.
    pub(super) fn by_arcs(&mut self) -> Option<f64> {
        let (rod, shape) = (self.rod, self.shape);
        let configuration = self.configuration?;
        let segments = &shape.segments;
        let first_held = segments.len() - configuration.count();
        let places: SmallVec<[Place; 6]> = segments
            .iter()
            .zip(0..)
            .map(|(segment, i): (_, usize)| Place::new(segment.s, segment.start, i.checked_sub(first_held)))
            .collect();
        self.clamp(&places[0].knot());
        if self.proof.clamp_inside {
            return None;
        }
        let tangent = |(held, place): (&ActiveContact, &Place)| {
            let t = configuration.t(place.contact.unwrap_or_default());
            self.tangent((held.stretch, t), &held.hold, &place.at)
        };
        let tangents: SmallVec<[(Line, Option<f64>); 4]> =
            configuration.contacts.iter().zip(&places[first_held..]).map(tangent).collect();
        let (mut lowest, mut cuts) = (f64::INFINITY, MOST_CUTS);
        for (i, segment) in segments.iter().enumerate() {
            let tip = match places.get(i + 1) {
                Some(next) => *next,
                None if segment.s >= 1.0 => break,
                None if rod.is_straight() => {
                    let (at, length) = (places[i].at, 1.0 - segment.s);
                    let (x, y) = (at.x + length * at.cos, at.y + length * at.sin);
                    Place { s: 1.0, cut: Cut { x, y, ..segment.start }, at: Station { x, y, ..at }, contact: None }
                }
                None => Place::new(1.0, rod::at(rod, segment, 1.0), None),
            };
            // also where it is NaN
            if tip.s.partial_cmp(&segment.s) != Some(Ordering::Greater) {
                return None;
            }
            let mut open: SmallVec<[[Place; 2]; MOST_CUTS]> = smallvec![[places[i], tip]];
            while let Some(ends) = open.pop() {
                let part = self.part(segment, i, ends);
                let is_arc = matches!(part.hull, Hull::Arc(_)) || ends[1].s - ends[0].s < 4.0 * BESIDE_INFLECTION;
                if is_arc && let Some(height) = self.clear_part(&part, &tangents) {
                    lowest = lowest.min(height);
                    continue;
                }
                cuts = cuts.checked_sub(1)?;
                let s = self.cut_at(&part);
                let middle = Place::new(s, rod::at(rod, segment, s), None);
                open.extend([[ends[0], middle], [middle, ends[1]]]);
            }
        }
        Some(lowest)
    }

    fn part<'a>(&self, segment: &'a Segment, number: usize, ends: [Place; 2]) -> Part<'a> {
        let force = self.shape.force(number);
        let [from, to] = ends.each_ref().map(|place| (place.s, place.cut.moment));
        let arc = self.rod.one_bend(from, to, force).and_then(|bend| Arc::new(&ends, bend));
        let interval = || Interval::new(self.rod, ends[0].knot(), ends[1].knot(), number, force);
        Part { ends, segment, number, hull: arc.map_or_else(|| Hull::Interval(interval()), Hull::Arc) }
    }

    /// Where to cut a part in two: in the middle, or beside the inflection, where that is by the cubic through curvatures and rates at both ends,
    /// as of a part of constant stiffness.
    fn cut_at(&self, Part { ends: [from, to], segment: Segment { a, b, .. }, hull, .. }: &Part<'_>) -> f64 {
        let (length, middle) = (to.s - from.s, 0.5 * (from.s + to.s));
        if let Hull::Arc(_) = hull {
            return middle;
        }
        let curvature = |place: &Place| self.rod.curvature_at(place.s, place.cut.moment);
        let (first, last) = (curvature(from), curvature(to));
        if first * last >= 0.0 {
            return middle;
        }
        let softness = (last - first) / (to.cut.moment - from.cut.moment) * length;
        let rate = |Place { at, .. }: &Place| softness * (a * at.cos + b * at.sin);
        let (start, end) = (rate(from), rate(to));
        let (bend, twist) = (3.0 * (last - first) - 2.0 * start - end, start + end - 2.0 * (last - first));
        let mut share = first / (first - last);
        for _ in 0..3 {
            let value = first + share * (start + share * (bend + share * twist));
            share = (share - value / (start + share * (2.0 * bend + share * 3.0 * twist))).clamp(0.0, 1.0);
        }
        let beside = BESIDE_INFLECTION / length;
        let share = if share > 2.0 * beside { share - beside } else { share + beside };
        from.s + length * if share.is_nan() { 0.5 } else { share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE) }
    }

    /// A lower bound of the distance of a part from all runs near it.
    fn clear_part(&mut self, part: &Part<'_>, tangents: &[(Line, Option<f64>)]) -> Option<f64> {
        let world = self.world;
        if world.is_small() {
            return (0..world.runs())
                .try_fold(f64::INFINITY, |lowest, run| Some(self.clear_of_run(run, part, tangents)?.min(lowest)));
        }
        let mut near: SmallVec<[usize; CROWD]> = SmallVec::new();
        world.runs_near(part.bounds().grown(GATE), |run| {
            if near.len() <= CROWD {
                near.push(run);
            }
        });
        if near.len() > CROWD {
            return None;
        }
        near.into_iter()
            .try_fold(f64::INFINITY, |lowest, run| Some(self.clear_of_run(run, part, tangents)?.min(lowest)))
    }

    /// A lower bound of the distance of a part from a run: by a tangent at a contact, by their curvatures beside one, by a line that is known, or
    /// by one that the closest points of its ends suggest.
    fn clear_of_run(&mut self, run: usize, part: &Part<'_>, tangents: &[(Line, Option<f64>)]) -> Option<f64> {
        self.take(run);
        let (world, configuration) = (self.world, self.configuration?);
        let known = *self.run();
        if are_apart(&part.bounds(), &known.bounds) {
            return Some(GATE);
        }
        let (least, mut touches) = (self.least(), false);
        for ((tangent, sense), (held, j)) in tangents.iter().zip(configuration.contacts.iter().zip(0..)) {
            if world.object(held.stretch) != self.object {
                continue;
            }
            let own = part.ends.iter().position(|end| end.contact == Some(j));
            let height = if known.bend == Bend::Outward { part.least_height(tangent) } else { f64::NEG_INFINITY };
            let clears = height > if own.is_some() { least } else { GATE };
            if !clears && own.is_none() || !world.is_on_run(run, held.stretch, configuration.t(j)) {
                continue;
            }
            if clears {
                return Some(height);
            }
            touches = true;
            let sense = sense.filter(|_| !world.is_corner(held.stretch));
            let (Some(sense), Some(end)) = (sense, own) else { continue };
            let [from, to] = part.ends.each_ref().map(Place::knot);
            let interval = Interval::new(self.rod, from, to, part.number, self.shape.force(part.number));
            let place = (held.stretch, configuration.t(j));
            let bound = self.compare_parallel(&known, place, &interval, (end == 0, sense));
            if let Some(bound) = bound.filter(|bound| *bound > least) {
                return Some(bound);
            }
        }
        let clears = |line: &Line| part.least_height(line) > GATE;
        if self.lines().find(clears).is_some() {
            return Some(GATE);
        }
        // no other line separates what touches
        if touches {
            return None;
        }
        for knot in part.ends.each_ref().map(Place::knot) {
            let foot = self.foot(&knot);
            if !foot.foot.gap.is_finite() {
                return None;
            }
            let mut found = None;
            self.candidates(&known, &foot, &knot, part.ends[1].s - part.ends[0].s, |line| {
                let clears = clears(&line);
                found = clears.then_some(line).or(found);
                clears
            });
            if let Some(line) = found {
                self.lines().keep(line);
                return Some(GATE);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rod_core::Uniform;
    use std::f64::consts::PI;

    proptest! {
        #[test]
        fn an_arc_does_not_fall_below_the_height_of_its_triangle(
            (phi, kappa, a, b) in (-3.2..3.2f64, -4.0..4.0f64, -20.0..20.0f64, -20.0..20.0f64),
            length in 1e-3..1.0f64,
            (x, y, turn) in (-0.5..0.5f64, -0.5..0.5f64, -3.2..3.2f64),
        ) {
            let segment = Segment { s: 0.0, start: Cut { x: 0.0, y: 0.0, phi, moment: kappa }, a, b };
            let place = |s: f64| Place::new(s, rod::at(&Uniform, &segment, s), None);
            let ends = [place(0.0), place(length)];
            let bend = Uniform.one_bend((0.0, kappa), (length, ends[1].cut.moment), a.hypot(b));
            prop_assume!(bend.is_some());
            let arc = Arc::new(&ends, bend.unwrap());
            prop_assume!(arc.is_some());
            let arc = arc.unwrap();
            let line = |at: (f64, f64), turn: f64| Line { at, normal: (turn.cos(), turn.sin()), outward: true };
            // any line, and the tangents at both ends, on the side of the arc
            let tangent = |Place { cut, .. }: &Place| line((cut.x, cut.y), cut.phi + PI / 2.0_f64.copysign(bend.unwrap()));
            let lines = [line((x, y), turn), tangent(&ends[0]), tangent(&ends[1])];
            for (number, line) in lines.iter().enumerate() {
                let least = arc.least_height(&ends, line);
                prop_assert!(number == 0 || least > -1e-11, "{number}: {least}");
                for k in 0..=64 {
                    let Cut { x, y, .. } = place(length * f64::from(k) / 64.0).cut;
                    let height = (x - line.at.0) * line.normal.0 + (y - line.at.1) * line.normal.1;
                    prop_assert!(height >= least - 1e-13, "{number} {k}: {height} {least}");
                }
            }
        }
    }
}
