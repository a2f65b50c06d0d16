//! Places, directions and angles in the plane.

use std::f64::consts::{PI, TAU};

/// A place in the plane, `[x, y]`, lengths: m, or dimensionless where all of a scene is.
pub type Point = [f64; 2];

/// A displacement, a direction or a derivative of a place, `[x, y]`.
pub type Vector = [f64; 2];

/// Largest turn, rad, that is still a smooth joint: the rounding error between tangents that should be equal.
pub(crate) const SMOOTH: f64 = 1e-9;

/// Distance of the last from the first point, relative to the circumference, below which the last point repeats the first.
const CLOSED: f64 = 1e-9;

/// From `p` to `q` by the fraction `t`; both come out exactly.
pub(crate) fn lerp(p: Point, q: Point, t: f64) -> Point {
    [0, 1].map(|k| p[k] * (1.0 - t) + q[k] * t)
}

/// `p + s q`.
pub(crate) fn plus(p: Vector, s: f64, q: Vector) -> Vector {
    [p[0] + s * q[0], p[1] + s * q[1]]
}

pub(crate) fn minus(p: Vector, q: Vector) -> Vector {
    [p[0] - q[0], p[1] - q[1]]
}

pub(crate) fn scale(factor: f64, [x, y]: Vector) -> Vector {
    [factor * x, factor * y]
}

pub(crate) fn dot(p: Vector, q: Vector) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

/// The distance between two points, without overflow.
pub(crate) fn distance(p: Point, q: Point) -> f64 {
    let [x, y] = minus(q, p);
    x.hypot(y)
}

/// Positive where `q` is to the left of `p`.
pub(crate) fn cross(p: Vector, q: Vector) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

/// Whether the last point repeats the first one.
pub(crate) fn is_closed(points: &[Point]) -> bool {
    let [first, .., last] = *points else { return false };
    let around: f64 = points.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    distance(first, last) <= CLOSED * around
}

/// The same angle (rad) in the turn in which it is nearest to another one.
pub(crate) fn nearest_turn(angle: f64, other: f64) -> f64 {
    angle + TAU * ((other - angle) / TAU).round()
}

/// The same angle between -pi and pi, rad.
pub(crate) fn wrap_angle(angle: f64) -> f64 {
    if angle.abs() <= PI { angle } else { nearest_turn(angle, 0.0) }
}
