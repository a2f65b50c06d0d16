//! The nearest place of a trace.

use crate::contour::TracePoint;
use crate::numeric::wrap_angle;

/// A place on the polygon through a trace's points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub point: TracePoint,
    /// Number of the edge, and the share of it that is passed.
    pub edge: usize,
    pub share: f64,
    pub distance: f64,
    /// Whether the trace goes on to both sides, so that the distance is one across it.
    pub interior: bool,
}

/// Largest angle (radians) between a chord and the tangents at its ends at which an arc is put through both.
const STEEPEST: f64 = 0.3;
/// Largest difference of the two angles, relative to the larger one, at which an arc is put through both.
const UNEQUAL: f64 = 0.5;

/// The place at a share of the distance between two points: on the cubic with their tangents, where these fit an arc; otherwise on
/// the chord.
fn between(a: &TracePoint, b: &TracePoint, share: f64) -> TracePoint {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let chord = dy.atan2(dx);
    let (start, end) = (wrap_angle(a.alpha - chord), wrap_angle(b.alpha - chord));
    let most = start.abs().max(end.abs());
    let arc = most <= STEEPEST && (start + end).abs() <= UNEQUAL * most;
    let left = share * (1.0 - share) * ((1.0 - share) * start.tan() - share * end.tan());
    let left = if arc { left } else { 0.0 };
    TracePoint {
        x: a.x + share * dx - left * dy,
        y: a.y + share * dy + left * dx,
        alpha: wrap_angle(a.alpha + share * wrap_angle(b.alpha - a.alpha)),
        sigma: a.sigma + share * (b.sigma - a.sigma),
        systematic: a.systematic + share * (b.systematic - a.systematic),
    }
}

/// The nearest place of the polygon; none without points.
pub(super) fn nearest(points: &[TracePoint], x: f64, y: f64) -> Option<Nearest> {
    let first = points.first()?;
    let alone =
        Nearest { point: *first, edge: 0, share: 0.0, distance: (x - first.x).hypot(y - first.y), interior: false };
    let mut best: Option<(f64, usize, f64, bool)> = None;
    for (edge, pair) in points.windows(2).enumerate() {
        let (a, b) = (&pair[0], &pair[1]);
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let free = ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy);
        let share = free.clamp(0.0, 1.0);
        let (u, v) = (a.x + share * dx - x, a.y + share * dy - y);
        let square = u * u + v * v;
        if best.is_none_or(|(least, ..)| square < least) {
            let beyond = (edge == 0 && free < 0.0) || (edge + 2 == points.len() && free > 1.0);
            best = Some((square, edge, share, !beyond));
        }
    }
    let Some((square, edge, share, interior)) = best else { return Some(alone) };
    let point = between(&points[edge], &points[edge + 1], share);
    // beyond an end of the trace there is no arc, and the distance is that to the end itself
    let distance = if interior { (point.x - x).hypot(point.y - y) } else { square.sqrt() };
    Some(Nearest { point, edge, share, distance, interior })
}

/// Places of the polygon through these points, the points among them, no farther apart than `step`.
pub(super) fn resample(points: &[TracePoint], step: f64) -> impl Iterator<Item = TracePoint> {
    let last = points.last().copied();
    let edge = move |pair: &[TracePoint]| {
        let (a, b) = (pair[0], pair[1]);
        let parts = ((b.x - a.x).hypot(b.y - a.y) / step).ceil().clamp(1.0, 1e4);
        (0..parts as usize).map(move |k| between(&a, &b, k as f64 / parts))
    };
    points.windows(2).flat_map(edge).chain(last)
}
