//! Points of the plane.

pub type Point = [f64; 2];

pub fn plus(a: Point, factor: f64, b: Point) -> Point {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}

pub fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Where on the segment from `a` to `b` the point is nearest, as a share, and how far it is from there.
pub fn nearest_on_segment(a: Point, b: Point, point: Point) -> (f64, f64) {
    let chord = minus(b, a);
    let share = (dot(minus(point, a), chord) / dot(chord, chord)).clamp(0.0, 1.0);
    let share = if share.is_nan() { 0.0 } else { share };
    (share, distance(plus(a, share, chord), point))
}

/// Whether two segments cross or touch.
pub fn segments_meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |p: Point, q: Point, r: Point| cross(minus(q, p), minus(r, p));
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Distance of two segments.
pub fn between_segments(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let ends = [(a, b, c), (a, b, d), (c, d, a), (c, d, b)];
    let least = ends.into_iter().map(|(p, q, r)| nearest_on_segment(p, q, r).1).fold(f64::INFINITY, f64::min);
    if least > 0.0 && segments_meet(a, b, c, d) && !parallel(a, b, c, d) { 0.0 } else { least }
}

/// Segments on one line, between which the test of sides says nothing.
fn parallel(a: Point, b: Point, c: Point, d: Point) -> bool {
    cross(minus(b, a), minus(d, c)) == 0.0
}
