//! The gap of the rod next to a touch, and to what bends away from it: bounds that no line gives.

use super::{LARGEST_TURN, Search, rate};
use crate::gap::interval::{Interval, Knot};
use crate::scene::world::{AHEAD, RunFoot};
use rod_contours::{Bend, Run};
use rod_core::Hold;

/// Sine of the angle between rod and contour below which they count as parallel.
const PARALLEL: f64 = 1e-9;
/// Room for rounding in the curvatures that are compared, in units of 1 / L.
const SLACK: f64 = 1e-9;
/// Largest number of intervals that are compared with the contour at once.
const AT_ONCE: usize = 6;

impl Search<'_> {
    /// How many intervals from number `i` on, up to number `last`, next to a contact with the run, are clear of it.
    pub(super) fn beside_contact(&mut self, i: usize, last: usize) -> Option<usize> {
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
        let segment = self.shape.nodes[i].segment;
        // as many intervals as there may be, then one alone
        let most = if forward { AT_ONCE.min(self.shape.last_of(segment).min(last) - i) } else { 1 };
        [most, 1].into_iter().take(if most > 1 { 2 } else { 1 }).find_map(|count| {
            let [from, to] = [i, i + count].map(|k| Knot::from(&self.shape.nodes[k]));
            let part = Interval::new(from, to, segment, self.shape.force(segment));
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

    /// Lower bound of the gap along an interval that begins (or, where it does not go `forward`, ends) where the rod is
    /// parallel to the contour. There both are graphs over the common tangent, with d(sin theta)/dx = curvature: while the rod
    /// bends towards the solid by no more than the contour does, slopes and heights stay in order.
    pub(super) fn compared(
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
