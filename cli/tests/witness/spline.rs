//! The cubics of a spline with continuous curvature whose parameter is the length of the polygon of its points.

use super::curve::Curve;
use super::vector::{Point, distance, minus, plus};

/// Sweeps over the equations. They are dominated by their diagonal two to one: each sweep halves the error at least.
const SWEEPS: usize = 80;

/// The spline through the points, closed or with ends that do not bend.
pub fn spline(points: &[Point], closed: bool) -> Vec<Curve> {
    let n = points.len();
    let count = if closed { n } else { n - 1 };
    let width = |k: usize| distance(points[k], points[(k + 1) % n]);
    let chord = |k: usize| minus(points[(k + 1) % n], points[k]).map(|side| side / width(k));
    let mut rates: Vec<Point> = (0..n).map(|k| chord(k.min(count - 1))).collect();
    for _ in 0..SWEEPS {
        for k in 0..n {
            rates[k] = match (closed, k) {
                (false, 0) => natural(chord(0), rates[1]),
                (false, k) if k == n - 1 => natural(chord(k - 1), rates[k - 1]),
                _ => {
                    let (before, after) = ((k + n - 1) % n, (k + 1) % n);
                    let share = width(k) / (width(before) + width(k));
                    let right = plus(chord(before).map(|side| 3.0 * share * side), 3.0 * (1.0 - share), chord(k));
                    plus(plus(right, -share, rates[before]), share - 1.0, rates[after]).map(|side| 0.5 * side)
                }
            };
        }
    }
    let cubic = |k: usize| {
        let (a, b) = (points[k], points[(k + 1) % n]);
        let third = width(k) / 3.0;
        Curve::Cubic([a, plus(a, third, rates[k]), plus(b, -third, rates[(k + 1) % n]), b])
    };
    (0..count).map(cubic).collect()
}

/// The rate at an end without curvature.
fn natural(chord: Point, neighbour: Point) -> Point {
    plus(chord.map(|side| 1.5 * side), -0.5, neighbour)
}
