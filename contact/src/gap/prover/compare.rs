//! The gap of the rod next to a touch, and to what bends away from it: bounds that no line gives.

use super::{LARGEST_TURN, Search, rate};
use crate::contact_set::ActiveContact;
use crate::gap::interval::{Interval, Knot};
use crate::gap::separator::Line;
use crate::scene::world::{AHEAD, RunFoot};
use rod_contours::{Bend, Run};
use rod_core::{Hold, RodModel, Station};
use smallvec::SmallVec;

/// Sine of the angle between rod and contour below which they count as parallel.
const PARALLEL: f64 = 1e-9;
/// Room for rounding in the curvatures that are compared, in units of 1 / L.
const SLACK: f64 = 1e-9;
/// Largest number of intervals that are compared with the contour at once.
const AT_ONCE: usize = 6;

/// A contact with the run that is looked at.
pub(super) struct Touch {
    /// The point of the rod.
    node: usize,
    stretch: usize,
    t: f64,
    /// The tangent of a run that bends outwards, which keeps the run behind it; none of another one.
    pub tangent: Option<Line>,
    /// Whether the rod is parallel to the run, which is smooth there: 1 where it runs along it, -1 against it.
    sense: Option<f64>,
}

impl<M: RodModel> Search<'_, M> {
    /// The contacts with the run between two nodes.
    pub(super) fn touches(&self, first: usize, last: usize) -> SmallVec<[Touch; 2]> {
        let Some(configuration) = self.configuration else { return SmallVec::new() };
        let touch = |(j, ActiveContact { stretch, hold, .. }): (usize, &ActiveContact)| {
            let (node, t) = (self.shape.node_of(j), configuration.t(j));
            if !(first..=last).contains(&node) || !self.world.is_on_run(self.run, *stretch, t) {
                return None;
            }
            let (tangent, sense) = self.tangent((*stretch, t), hold, &self.shape.nodes[node].at);
            let outward = self.known.lines[self.place].run.is_some_and(|run| run.bend == Bend::Outward);
            let tangent = outward.then_some(tangent);
            let joint = self.world.is_corner(*stretch);
            Some(Touch { node, stretch: *stretch, t, tangent, sense: sense.filter(|_| !joint) })
        };
        configuration.contacts.iter().enumerate().filter_map(touch).collect()
    }

    /// The tangent of the contour at a contact, whose stretch and parameter are given, and the sense in which a tangential rod runs along it. The
    /// rod, which is `at` its contact, then points along or against the contour.
    pub(super) fn tangent(
        &self,
        (stretch, t): (usize, f64),
        hold: &Hold,
        &Station { x, y, cos, sin, .. }: &Station,
    ) -> (Line, Option<f64>) {
        let (sense, normal) = match hold {
            Hold::Tangent { offset } => {
                let sense = 1.0_f64.copysign(offset.cos());
                (Some(sense), (sense * sin, -sense * cos))
            }
            Hold::Tip => (None, self.world.foot_at(stretch, t, x, y).normal()),
        };
        (Line { at: (x, y), normal, outward: true }, sense)
    }

    /// How many intervals from number `i` on, up to number `last`, next to a contact with the run, are clear of it.
    pub(super) fn beside_touch(&mut self, touches: &[Touch], i: usize, last: usize) -> Option<usize> {
        let beside = |touch: &Touch| Some((touch.node, (touch.stretch, touch.t), touch.sense?));
        let (node, place, sense) = touches.iter().filter_map(beside).find(|(node, ..)| *node == i || *node == i + 1)?;
        let forward = node == i;
        let segment = self.shape.nodes[i].segment;
        // as many intervals as there may be, then one alone
        let most = if forward { AT_ONCE.min(self.shape.last_of(segment).min(last) - i) } else { 1 };
        [most, 1].into_iter().take(if most > 1 { 2 } else { 1 }).find_map(|count| {
            let [from, to] = [i, i + count].map(|k| Knot::from(&self.shape.nodes[k]));
            let part = Interval::new(self.rod, from, to, segment, self.shape.force(segment));
            let run = *self.run();
            let bound =
                self.compare_parallel(&run, place, &part, (forward, sense)).filter(|bound| *bound > self.least())?;
            self.note(if forward { i } else { i + count - 1 }, bound, false);
            Some(count)
        })
    }

    /// [`compare_parallel`](Self::compare_parallel) at a foot, where rod and contour may be parallel.
    pub(super) fn compare_on_tangent(
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
        let sense = 1.0_f64.copysign(knot.at.cos * cos + knot.at.sin * sin);
        let above = self.compare_parallel(run, (*stretch, foot.t), part, (forward, sense))?;
        Some(foot.gap - AHEAD * part.length * slope.abs() + above)
    }

    /// Lower bound of the gap along an interval that begins (or, where it does not go `forward`, ends) where the rod touches the contour and
    /// is parallel to it, in the same `sense` or against it. There both are graphs over the common tangent, with d(sin theta)/dx =
    /// curvature: while the rod bends towards the solid by no more than the contour does, slopes and heights stay in order. A contour that
    /// bends outwards stays behind its tangent, and a rod that bends away from the solid in front of it. Where such a contour has turned
    /// more than the rod does at all, its tangent keeps the two apart from there on.
    pub(super) fn compare_parallel(
        &self,
        run: &Run,
        (stretch, t): (usize, f64),
        part: &Interval,
        (forward, sense): (bool, f64),
    ) -> Option<f64> {
        let bend = (sense * part.curvature.0).max(sense * part.curvature.1);
        if part.bent * part.length > LARGEST_TURN {
            return None;
        }
        let outward = run.bend == Bend::Outward;
        if outward && bend <= 0.0 {
            return Some(0.0);
        }
        let ahead = if forward { sense } else { -sense };
        let ways = (part.length, bend.max(0.0) * part.length);
        let least = self.world.curvature_ahead(outward, stretch, t, ahead, ways, LARGEST_TURN)?;
        (bend <= least + SLACK).then_some(-SLACK * part.length * part.length)
    }

    /// Lower bound of the gap between two feet on a run that bends inwards somewhere: g'' >= -k - q / (1 - q g), where the
    /// rod's curvature is at most k and the run's at most q away from the solid. As long as q g < 1 the foot of an arc that
    /// turns by no more than a right angle moves without a jump.
    pub(super) fn concave(&self, run: &Run, [from, to]: &[RunFoot; 2], part: &Interval) -> Option<f64> {
        let (g0, g1) = (from.foot.gap, to.foot.gap);
        if run.bend == Bend::Outward || from.end.is_some() || to.end.is_some() || g0.min(g1) < -self.depth {
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
}
