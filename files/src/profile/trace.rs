//! A contour as points that are close enough together.

use super::ProfilePoint;
use super::reach::Reach;
use std::f64::consts::TAU;
use vibrissa::Composite;
use vibrissa::contour::{Frame, Range, StretchKind};

/// Distance of a point from the corner or notch beside it, in lengths of the rod.
const ASIDE: f64 = 1e-9;

/// The largest share of a piece that is left out beside a corner.
const SHARE: f64 = 0.25;

/// Pieces in which a part that bends is looked at in any case.
const FIRST: usize = 4;

/// Turn (rad) of a part that is straight: rounding.
const STRAIGHT: f64 = 1e-12;

/// The angle (rad) between a chord and a tangent from which on the triangle of the two tangents says nothing.
const STEEP: f64 = 0.5;

/// Most times a part is halved: then neighbouring points differ by rounding.
const HALVINGS: u32 = 48;

/// Gauss-Legendre points and weights on -1 to 1, of degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 128.0 / 225.0),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// A place on a stretch, by its own parameter.
#[derive(Clone, Copy)]
struct StretchPoint {
    t: f64,
    frame: Frame,
}

/// Collects the points of a contour.
pub(super) struct Tracer<'a> {
    contour: &'a Composite,
    /// m
    tolerance: f64,
    /// m
    aside: f64,
    room: usize,
    /// m
    arc_length: f64,
    pub points: Vec<ProfilePoint>,
    pub joints: Vec<[f64; 2]>,
}

impl<'a> Tracer<'a> {
    /// Points of `contour` with chords within `tolerance` (m) for a rod of this length (m), at most so many.
    pub fn new(contour: &'a Composite, tolerance: f64, length: f64, room: usize) -> Self {
        let (points, joints) = (Vec::new(), Vec::new());
        Self { contour, tolerance, aside: ASIDE * length, room, arc_length: 0.0, points, joints }
    }

    /// Goes along the contour; none where there is not enough room.
    pub fn run(&mut self, reach: &Reach) -> Option<()> {
        let parts: Vec<_> = self.contour.parts().filter(|part| self.is_piece(part.stretch)).collect();
        let (mut first_aside, mut aside_at_end) = (0.0, 0.0);
        for run in parts.chunk_by(|one, other| one.stretch == other.stretch) {
            let stretch = run[0].stretch;
            let (before, after) = (self.joint(stretch, false), self.joint(stretch, true));
            let whole = reach.range(self.contour, stretch);
            let aside = |joint: bool, t: f64| {
                let speed = self.contour.own_frame(stretch, t).speed;
                if joint { (self.aside / speed).min(SHARE * whole.length()) } else { 0.0 }
            };
            let shown = Range { from: whole.from + aside(before, whole.from), to: whole.to - aside(after, whole.to) };
            // The way from the vertex and to the next one belongs to the contour.
            self.arc_length += aside_at_end + self.way(stretch, whole.from, shown.from);
            aside_at_end = self.way(stretch, shown.to, whole.to);
            // None before the first piece of an open contour.
            if self.contour.neighbour(stretch, false).is_some() {
                let frame = self.contour.own_frame(stretch, whole.from);
                self.joints.push([frame.x, frame.y]);
            }
            let start = self.place(stretch, shown.from);
            if self.points.is_empty() {
                first_aside = std::mem::take(&mut self.arc_length);
            }
            if self.points.is_empty() || before {
                self.push(start.frame);
            }
            let mut last = start;
            for part in run {
                let part = part.range.within(shown);
                if part.from >= part.to {
                    continue;
                }
                let end = self.place(stretch, part.to);
                self.part(stretch, last, end)?;
                last = end;
            }
        }
        self.close(aside_at_end, first_aside);
        Some(())
    }

    fn is_piece(&self, stretch: usize) -> bool {
        matches!(self.contour.kind(stretch), StretchKind::Piece(_))
    }

    /// Whether a corner or notch stands before or after a piece.
    fn joint(&self, stretch: usize, after: bool) -> bool {
        self.contour.neighbour(stretch, after).is_some_and(|next| !self.is_piece(next))
    }

    fn place(&self, stretch: usize, t: f64) -> StretchPoint {
        StretchPoint { t, frame: self.contour.own_frame(stretch, t) }
    }

    fn push(&mut self, frame: Frame) {
        // No negative zeros in a file.
        let [x, y, tangent_angle, curvature] =
            [frame.x, frame.y, frame.alpha, frame.curvature()].map(|value| value + 0.0);
        self.points.push(ProfilePoint { x, y, tangent_angle, curvature, arc_length: self.arc_length });
    }

    /// The points after the first one of a part that bends one way only.
    fn part(&mut self, stretch: usize, from: StretchPoint, to: StretchPoint) -> Option<()> {
        let at = |share: usize| from.t + (to.t - from.t) * share as f64 / FIRST as f64;
        let angles = (0..=FIRST).map(|share| self.contour.own_frame(stretch, at(share)).alpha);
        if angles.clone().all(|angle| (angle - from.frame.alpha).abs() <= STRAIGHT) {
            return self.go(stretch, from.t, to);
        }
        let mut last = from;
        for share in 1..=FIRST {
            let next = if share == FIRST { to } else { self.place(stretch, at(share)) };
            self.halve(stretch, last, next, HALVINGS)?;
            last = next;
        }
        Some(())
    }

    fn halve(&mut self, stretch: usize, from: StretchPoint, to: StretchPoint, halvings: u32) -> Option<()> {
        let middle = self.place(stretch, 0.5 * (from.t + to.t));
        if halvings == 0 || off_chord(from.frame, middle.frame, to.frame) <= self.tolerance {
            return self.go(stretch, from.t, to);
        }
        self.halve(stretch, from, middle, halvings - 1)?;
        self.halve(stretch, middle, to, halvings - 1)
    }

    /// Adds a point.
    fn go(&mut self, stretch: usize, from: f64, to: StretchPoint) -> Option<()> {
        if self.points.len() >= self.room {
            return None;
        }
        self.arc_length += self.way(stretch, from, to.t);
        self.push(to.frame);
        Some(())
    }

    /// Length of the contour between two places that are near each other, m.
    fn way(&self, stretch: usize, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        half * GAUSS
            .iter()
            .map(|(t, weight)| weight * self.contour.own_frame(stretch, middle + half * t).speed)
            .sum::<f64>()
    }

    /// Comes back to the first point of a closed contour, over a corner if the way to it and from it (m) is not 0.
    fn close(&mut self, before: f64, after: f64) {
        let Some(first) = self.points.first().copied().filter(|_| self.contour.is_closed()) else { return };
        let turn = if self.contour.is_cavity() { -TAU } else { TAU };
        let end = ProfilePoint { tangent_angle: first.tangent_angle + turn, ..first };
        let corner = before > 0.0;
        match self.points.last_mut() {
            // The end of the last piece is the start of the first one, to rounding.
            Some(last) if !corner => *last = ProfilePoint { arc_length: last.arc_length, ..end },
            _ => self.points.push(ProfilePoint { arc_length: self.arc_length + before + after, ..end }),
        }
    }
}

/// How far the contour can be from the chord between two of its points, m, where it bends one way: the height of the
/// triangle of the chord and both tangents.
fn off_chord(from: Frame, middle: Frame, to: Frame) -> f64 {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return (middle.x - from.x).hypot(middle.y - from.y);
    }
    let slope = |frame: Frame| {
        let (sin, cos) = frame.alpha.sin_cos();
        let (along, across) = (dx * cos + dy * sin, dx * sin - dy * cos);
        across.atan2(along)
    };
    let (start, end) = (slope(from), slope(to));
    if start.abs() > STEEP || end.abs() > STEEP {
        return f64::INFINITY;
    }
    let (start, end) = (start.tan().abs(), end.tan().abs());
    let triangle = if start + end > 0.0 { length * start * end / (start + end) } else { 0.0 };
    // Where it bends both ways after all.
    let seen = ((middle.x - from.x) * dy - (middle.y - from.y) * dx).abs() / length;
    triangle.max(seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_of_a_circle() {
        let on = |angle: f64| Frame { x: angle.sin(), y: -angle.cos(), alpha: angle, speed: 1.0, turning: 1.0 };
        let (bound, sagitta) = (off_chord(on(-0.1), on(0.0), on(0.1)), 1.0 - 0.1_f64.cos());
        assert!(bound >= sagitta && bound < 2.1 * sagitta, "{bound} {sagitta}");
        assert_eq!(off_chord(on(-2.0), on(0.0), on(2.0)), f64::INFINITY);
    }
}
