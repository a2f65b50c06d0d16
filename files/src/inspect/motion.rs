//! How the clamp moves, in words.

use std::f64::consts::TAU;
use vibrissa::reconstruct::passes;
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Rod, Sample};

/// The name of the fact.
pub(super) const MOTION: &str = "motion of the clamp";
/// Departure from a shape of the path, relative to the way, that counts as measuring error.
const STRAIGHT: f64 = 2e-3;

/// The motion through these poses, m and rad.
pub(super) fn motion(poses: &[Pose]) -> Option<String> {
    let (first, last) = (poses.first()?, poses.last()?);
    let range = |of: fn(&Pose) -> f64| {
        let (least, most) =
            poses.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        most - least
    };
    let [width, height, turn] = [range(|p| p.x), range(|p| p.y), range(|p| p.phi)];
    let size = width.hypot(height);
    let angle = if turn < 1e-9 {
        format!("the angle stays {:.3} degrees", first.phi.to_degrees())
    } else {
        format!("it turns by {:.3} degrees", turn.to_degrees())
    };
    if size < 1e-12 {
        return Some(if turn < 1e-9 {
            "the clamp stands still".to_owned()
        } else {
            format!("the clamp only turns: {angle}")
        });
    }
    let path = if let Some(direction) = straight(poses, size) {
        format!("straight, {:.2} mm along {:.1} degrees from x", 1e3 * size, direction.to_degrees())
    } else if let Some((radius, x, y)) = arc(poses, size) {
        format!("an arc of radius {:.2} mm about ({:.2}, {:.2}) mm", 1e3 * radius, 1e3 * x, 1e3 * y)
    } else {
        format!("curved, within {:.2} mm x {:.2} mm", 1e3 * width, 1e3 * height)
    };
    let there = Rod::new(size, 1.0).map_or(1, |rod| {
        let samples: Vec<Sample> = poses.iter().map(|pose| Sample::new(*pose, Reactions::default())).collect();
        passes(&rod, &samples).len()
    });
    let there = if there > 1 { format!(", {there} passes there and back") } else { String::new() };
    let start = format!("from ({:.2}, {:.2}) mm", 1e3 * first.x, 1e3 * first.y);
    let end = format!("to ({:.2}, {:.2}) mm", 1e3 * last.x, 1e3 * last.y);
    Some(format!("{path}, {start} {end}{there}; {angle}"))
}

/// Direction of a straight path, in [0, 2 pi), if all poses are on it.
fn straight(poses: &[Pose], size: f64) -> Option<f64> {
    let first = poses.first()?;
    let distance = |pose: &&Pose| (pose.x - first.x).hypot(pose.y - first.y);
    let far = poses.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let (dx, dy) = (far.x - first.x, far.y - first.y);
    let length = dx.hypot(dy);
    let off = |pose: &Pose| ((pose.x - first.x) * dy - (pose.y - first.y) * dx).abs() / length;
    let is_straight = poses.iter().all(|pose| off(pose) <= STRAIGHT * size);
    is_straight.then(|| dy.atan2(dx).rem_euclid(TAU) % TAU)
}

/// Radius and centre of an arc, if all poses are on it: through the first, the middle and the last one.
fn arc(poses: &[Pose], size: f64) -> Option<(f64, f64, f64)> {
    let (a, b, c) = (poses.first()?, poses.get(poses.len() / 2)?, poses.last()?);
    let (bx, by, cx, cy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let area = 2.0 * (bx * cy - by * cx);
    let (bb, cc) = (bx * bx + by * by, cx * cx + cy * cy);
    let (x, y) = ((cy * bb - by * cc) / area, (bx * cc - cx * bb) / area);
    let radius = x.hypot(y);
    let (x, y) = (a.x + x, a.y + y);
    let is_arc = radius.is_finite()
        && poses.iter().all(|pose| ((pose.x - x).hypot(pose.y - y) - radius).abs() <= 5.0 * STRAIGHT * size);
    is_arc.then_some((radius, x, y))
}
