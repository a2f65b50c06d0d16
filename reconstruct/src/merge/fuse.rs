//! Two traces of the same stretch of a contour made one.

use super::nearest::{Nearest, nearest};
use crate::contour::{Trace, TracePoint, simplify};
use crate::numeric::wrap_angle;

/// Traces agree at a place where their distance is within this many of its standard deviations.
const AGREE: f64 = 5.0;
/// Distance, m, within which they agree in any case: points that were left out depart by as much.
const LEFT_OUT: f64 = 5e-6;
/// Largest distance of places that do not agree but follow the same stretch, as a share of the shorter trace.
const FAR: f64 = 0.1;
/// Smallest cosine between the tangents of such places.
const PARALLEL: f64 = 0.88;
/// Points of the result are left out that depart from the chords of the others by less, m.
const TOLERANCE: f64 = 1e-6;

/// Whether two traces follow the same stretch, in part at least: most of the places that both passed agree.
pub(super) fn overlap(a: &Trace, b: &Trace) -> bool {
    let far = far(a, b);
    let (mut agree, mut all) = (0, 0);
    for (one, other) in [(a, b), (b, a)] {
        for place in &one.points {
            if let Some(near) = nearest_beside(place, other, far) {
                all += 1;
                agree += usize::from(agrees(place, &near));
            }
        }
    }
    all > 0 && 2 * agree >= all
}

/// How far apart two traces of the same stretch may be.
fn far(a: &Trace, b: &Trace) -> f64 {
    FAR * a.length().min(b.length())
}

/// The place of another trace beside a point, along the same stretch.
fn nearest_beside(place: &TracePoint, other: &Trace, far: f64) -> Option<Nearest> {
    let near = nearest(&other.points, place.x, place.y)?;
    let along = (near.point.alpha - place.alpha).cos();
    let same = (agrees(place, &near) && along > 0.0) || (near.distance <= far && along > PARALLEL);
    (near.interior && same).then_some(near)
}

fn agrees(place: &TracePoint, near: &Nearest) -> bool {
    near.distance <= AGREE * place.sigma.hypot(near.point.sigma) + LEFT_OUT
}

/// One trace through the places of both. Where both passed, it is their mean weighted by the inverse variances if they agree, and the
/// more certain one if they do not; elsewhere it is the only one.
pub(super) fn fuse_traces(a: &Trace, b: &Trace) -> Trace {
    let far = far(a, b);
    let along = lengths(&a.points);
    let mut places: Vec<(f64, TracePoint)> = Vec::new();
    for (place, &key) in a.points.iter().zip(&along) {
        places.extend(mean(place, b, far).map(|mean| (key, mean)));
    }
    for (place, key) in b.points.iter().zip(keys(b, a, &along, far)) {
        places.extend(mean(place, a, far).map(|mean| (key, mean)));
    }
    places.sort_by(|(a, p), (b, q)| a.total_cmp(b).then(p.x.total_cmp(&q.x)).then(p.y.total_cmp(&q.y)));
    let mut points: Vec<TracePoint> = places.into_iter().map(|(_, place)| place).collect();
    // two places in the wrong order along the contour, by noise
    points.dedup_by(|next, before| {
        let (sin, cos) = before.alpha.sin_cos();
        (next.x - before.x) * cos + (next.y - before.y) * sin <= 1e-9 && (next.alpha - before.alpha).cos() > 0.999
    });
    let (samples, reversed) = (a.samples.clone(), a.reversed);
    Trace { kind: a.kind, samples, reversed, points: simplify(&points, 0.0, TOLERANCE) }
}

/// The path length along `other` (whose path lengths are given) at each point of `one`. Beyond the common stretch it continues with
/// the path length of `one`.
fn keys(one: &Trace, other: &Trace, along: &[f64], far: f64) -> Vec<f64> {
    let own = lengths(&one.points);
    let common: Vec<Option<f64>> = one
        .points
        .iter()
        .map(|place| {
            let near = nearest_beside(place, other, far)?;
            Some(along[near.edge] + near.share * (along[near.edge + 1] - along[near.edge]))
        })
        .collect();
    let at = |k: usize| common[k].map(|key| (k, key));
    let ends = (0..common.len()).find_map(at).zip((0..common.len()).rev().find_map(at));
    let Some(((first, start), (last, end))) = ends else {
        // The other one lies between two points of this one.
        let (Some(place), Some(&length)) = (other.points.first(), along.last()) else { return own };
        let edge = nearest(&one.points, place.x, place.y).map_or(0, |near| near.edge);
        // Before the first point of the other, or beyond the last.
        let key = |k: usize| {
            if k <= edge { (own[k] - own[edge]).min(-f64::MIN_POSITIVE) } else { length + own[k] - own[edge + 1] }
        };
        return (0..own.len()).map(key).collect();
    };
    let mut before = start;
    (0..own.len())
        .map(|k| {
            let key = match common[k] {
                _ if k < first => start - (own[first] - own[k]),
                _ if k > last => end + (own[k] - own[last]),
                Some(key) => key,
                None => before,
            };
            before = key;
            key
        })
        .collect()
}

/// The mean of a point and another trace; none where the other one is more certain and they disagree.
fn mean(place: &TracePoint, other: &Trace, far: f64) -> Option<TracePoint> {
    let Some(near) = nearest_beside(place, other, far) else { return Some(*place) };
    if !agrees(place, &near) {
        return (place.sigma <= near.point.sigma).then_some(*place);
    }
    let random = |point: &TracePoint| (point.sigma * point.sigma - point.systematic * point.systematic).max(0.0);
    let (own, of_other) = (random(place), random(&near.point));
    let sum = own + of_other;
    let share = if sum > 0.0 { own / sum } else { 0.5 };
    let between = |from: f64, to: f64| from + share * (to - from);
    // what all samples share may be the same in both scans
    let systematic = between(place.systematic, near.point.systematic);
    let sigma = (if sum > 0.0 { own * of_other / sum } else { 0.0 } + systematic * systematic).sqrt();
    let alpha = wrap_angle(place.alpha + share * wrap_angle(near.point.alpha - place.alpha));
    Some(TracePoint { x: between(place.x, near.point.x), y: between(place.y, near.point.y), alpha, sigma, systematic })
}

/// The length of the polygon up to each point.
fn lengths(points: &[TracePoint]) -> Vec<f64> {
    let mut length = 0.0;
    let steps = points.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y));
    let beyond = steps.map(|step| {
        length += step;
        length
    });
    std::iter::once(0.0).chain(beyond).take(points.len()).collect()
}
