//! Where a spline is cut into simple arcs.

use std::f64::consts::FRAC_PI_2;

use super::Spline;
use crate::nearest::cuts::last_where;
use crate::{Contour, Range};

/// Cubics of an arc, so that its box stays small.
const CUBICS: usize = 4;

impl Spline {
    /// Parameters inside the range, in order, that part it into simple arcs: without an inflection inside, turning by a
    /// right angle at most, of four cubics at most.
    ///
    /// A curve that bends no more than rounding brings about counts as straight.
    pub(super) fn parted(&self, range: Range) -> Vec<f64> {
        let range = self.range().within(range);
        let mut cuts = Vec::new();
        let mut from = range.from;
        for inflection in self.inflections(range) {
            self.cut_arc(Range { from, to: inflection }, &mut cuts);
            cuts.push(inflection);
            from = inflection;
        }
        self.cut_arc(Range { from, to: range.to }, &mut cuts);
        cuts
    }

    /// Knots strictly inside the range.
    fn knots_in(&self, range: Range) -> impl Iterator<Item = f64> {
        let first = self.keys.cubic_at(range.from) + 1;
        (first..self.keys.len()).map(|index| self.keys.knot(index)).take_while(move |&t| t < range.to)
    }

    /// Where inside the range the tangent begins to turn back.
    fn inflections(&self, range: Range) -> Vec<f64> {
        let mut inflections = Vec::new();
        let mut sense = 0.0;
        let mut farthest = (range.from, self.frame(range.from).alpha);
        let mut from = range.from;
        let turns = |from: f64, to: f64| !self.is_straight(Range { from, to });
        for knot in self.knots_in(range).chain([range.to]) {
            let cubic = self.keys.cubic(self.keys.cubic_at(from));
            let velocity = cubic.velocity();
            let inside = velocity.inflections().map(|s| cubic.from + s * cubic.width);
            for t in inside.filter(|&t| from < t && t < knot).chain([knot]) {
                let alpha = self.frame(t).alpha;
                let moved = alpha - farthest.1;
                if sense == 0.0 {
                    if turns(farthest.0, t) {
                        (sense, farthest) = (moved.signum(), (t, alpha));
                    }
                } else if moved * sense >= 0.0 {
                    farthest = (t, alpha);
                } else if turns(farthest.0, t) {
                    inflections.push(farthest.0);
                    (sense, farthest) = (-sense, (t, alpha));
                }
            }
            from = knot;
        }
        inflections
    }

    /// Whether the range bends no more than rounding brings about.
    fn is_straight(&self, range: Range) -> bool {
        self.bends(1.0, range) && self.bends(-1.0, range)
    }

    /// Cuts an arc without inflections at knots, and between them where a single cubic turns by more than a right angle.
    fn cut_arc(&self, arc: Range, cuts: &mut Vec<f64>) {
        let angle = |t: f64| self.frame(t).alpha;
        let (mut start, mut end) = (arc.from, arc.from);
        let mut cubics = 0;
        for next in self.knots_in(arc).chain([arc.to]) {
            while cubics == CUBICS || (angle(next) - angle(start)).abs() > FRAC_PI_2 {
                if end == start {
                    end = self.right_angle(start, next);
                    if end <= start {
                        break;
                    }
                }
                cuts.push(end);
                start = end;
                cubics = 0;
            }
            end = next;
            cubics += 1;
        }
    }

    /// The last parameter between the two at which the tangent has not yet turned by more than a right angle.
    fn right_angle(&self, from: f64, to: f64) -> f64 {
        let start = self.frame(from).alpha;
        last_where(from, to, |t| (self.frame(t).alpha - start).abs() <= FRAC_PI_2)
    }
}
