//! Whether a point is in the solid of a closed boundary.

use super::boundary::Boundary;
use super::crossing::crossings;
use super::strand::Straight;
use super::vector::{Point, plus};

/// Directions of rays in which no boundary has been made.
const RAYS: [f64; 3] = [0.731_236, 2.904_871, 5.117_403];

/// By the first crossing of rays, most of three; false for an open boundary.
pub fn is_inside(boundary: &Boundary, point: Point) -> bool {
    let [left, bottom, right, top] = boundary.nodes[0].bounds;
    let out = point[0] < left || point[0] > right || point[1] < bottom || point[1] > top;
    if !boundary.closed {
        return false;
    }
    let size = (right - left) + (top - bottom) + if out { (point[0] - left).hypot(point[1] - bottom) } else { 0.0 };
    let votes = RAYS.into_iter().filter(|angle| {
        let (sin, cos) = angle.sin_cos();
        let ray = Straight { from: point, to: plus(point, 2.0 * size, [cos, sin]) };
        // what the ray leaves first is the solid; from beyond a cavity it meets nothing
        match crossings(&ray, [0.0, 1.0], boundary) {
            Ok(found) => found.first().map_or_else(|| boundary.cavity, |crossing| !crossing.enters),
            Err(()) => false,
        }
    });
    votes.count() >= 2
}
