//! The point where two pieces meet at an angle, and how it moves with a parameter of one of them.

use crate::point::{cross, minus, plus, wrap_angle};
use crate::{Bounds, Closest, Frame, FrameRate, Range, Vector};

/// A vertex: the point stands still while alpha runs from one tangent to the other. Its own parameter is the angle turned, from
/// 0: that of the composite, behind long pieces, would lose digits of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// The frame at the start, with speed 0 and turning +1 (convex corner) or -1 (notch).
    start: Frame,
    /// The composite's parameter where it begins.
    from: f64,
    /// The size of the turn, rad.
    turn: f64,
}

impl Joint {
    /// The joint that begins at parameter `from` in the point and direction of `before` and turns by `turn`, rad.
    pub fn new(before: Frame, from: f64, turn: f64) -> Self {
        Self { start: Frame { speed: 0.0, turning: turn.signum(), ..before }, from, turn: turn.abs() }
    }

    /// Its part of the composite's parameter.
    pub fn range(&self) -> Range {
        Range { from: self.from, to: self.from + self.turn }
    }

    /// The angle turned, from 0.
    pub fn own_range(&self) -> Range {
        Range { from: 0.0, to: self.turn }
    }

    /// The vertex as a box.
    pub fn bounds(&self) -> Bounds {
        Bounds::EMPTY.with(self.start.x, self.start.y)
    }

    /// Infinite, with the sign of the turn.
    pub fn curvature(&self) -> (f64, f64) {
        let curvature = f64::INFINITY.copysign(self.start.turning);
        (curvature, curvature)
    }

    /// The frame by its own parameter.
    pub fn frame(&self, u: f64) -> Frame {
        Frame { alpha: self.start.alpha + self.start.turning * u, ..self.start }
    }

    /// The vertex as seen from `(x, y)`, with the tangent, of those in `range` of its own parameter, whose normal points at
    /// `(x, y)` best.
    pub fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let convex = self.start.turning > 0.0;
        let (dx, dy) = (x - self.start.x, y - self.start.y);
        let middle = 0.5 * (range.from + range.to);
        // Seen from a corner the point lies against the normal, seen from a notch along it.
        let alpha = if convex { dx.atan2(-dy) } else { (-dx).atan2(dy) };
        let distance = dx.hypot(dy);
        let off = if distance > 0.0 { wrap_angle(alpha - self.frame(middle).alpha) } else { 0.0 };
        let t = middle + self.start.turning * off;
        // The solid at a corner is what lies left of both tangents, at a notch what lies left of either.
        let left = |t: f64| self.frame(t).local(x, y).1 < 0.0;
        let (first, second) = (left(0.0), left(self.turn));
        let inside = if convex { first && second } else { first || second };
        let on = range.clamp(t);
        Closest {
            t: on,
            gap: if inside { -distance } else { distance },
            frame: self.frame(on),
            interior: range.contains(t),
        }
    }
}

/// The change of a vertex, the point where the two pieces, continued, cross, per unit of a parameter.
pub(crate) struct VertexRate {
    /// Rate of the point.
    pub point: Vector,
    /// Rates of the parameters at which the two pieces end there.
    pub ends: [f64; 2],
    /// Rates of the tangent angles of the two pieces there, rad.
    pub alphas: [f64; 2],
}

impl VertexRate {
    /// The vertex between two pieces that end there in these frames, which change by `rates` at the fixed parameters of the
    /// ends.
    pub fn new(frames: [Frame; 2], rates: [FrameRate; 2]) -> Self {
        let along = frames.map(|Frame { alpha, speed, .. }| {
            let (sin, cos) = alpha.sin_cos();
            [speed * cos, speed * sin]
        });
        let points = rates.map(|rate| [rate.x, rate.y]);
        // r_1 + a r_1' = r_2 + b r_2'
        let (apart, across) = (minus(points[1], points[0]), cross(along[0], along[1]));
        let ends = [cross(apart, along[1]) / across, cross(apart, along[0]) / across];
        let alphas = [0, 1].map(|side| rates[side].alpha + ends[side] * frames[side].turning);
        Self { point: plus(points[0], ends[0], along[0]), ends, alphas }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(turn: f64) -> Joint {
        let before = Frame { x: 1.0, y: 2.0, alpha: -0.5 * turn, speed: 3.0, turning: 4.0 };
        Joint::new(before, 10.0, turn)
    }

    #[test]
    fn below_a_corner_the_normal_points_up() {
        let corner = vertex(1.0);
        let closest = corner.closest_in(corner.own_range(), 1.0, 1.5);
        assert!((closest.t - 0.5).abs() < 1e-15 && closest.frame.alpha.abs() < 1e-15);
        assert_eq!((closest.gap, closest.interior), (0.5, true));
        let aside = corner.closest_in(corner.own_range(), 2.0, 2.0);
        assert_eq!((aside.gap, aside.interior, aside.t), (1.0, false, 1.0));
        assert_eq!(corner.closest_in(corner.own_range(), 1.0, 2.5).gap, -0.5);
    }

    #[test]
    fn above_a_notch_lies_the_solid() {
        let notch = vertex(-1.0);
        let closest = notch.closest_in(notch.own_range(), 1.0, 2.5);
        assert!((closest.t - 0.5).abs() < 1e-15);
        assert_eq!((closest.gap, closest.interior), (-0.5, true));
        assert_eq!(notch.closest_in(notch.own_range(), 1.0, 1.5).gap, 0.5);
    }

    #[test]
    fn the_vertex_itself_is_on_the_contour() {
        let closest = vertex(1.0).closest_in(vertex(1.0).own_range(), 1.0, 2.0);
        assert_eq!((closest.gap, closest.interior, closest.t), (0.0, true, 0.5));
    }
}
