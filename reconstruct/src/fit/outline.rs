//! The order of contact points along the contour: the start of a fit.

use nalgebra::Vector2;
use std::collections::BTreeMap;

/// Distance of the points of the start, rod lengths.
pub(super) const SPACING: f64 = 0.03;
/// Two points closer than this share of the spacing are one.
const CLOSE: f64 = 0.4;
/// Points at an end that are left out, at most, and the step that parts them from the others, in spacings.
const STRAYS: usize = 3;
const STRAY_STEP: f64 = 6.0;
/// Distance of a point from the middle of its neighbours over theirs from which on it is noise, and how often it is brought nearer.
const ZIGZAG: f64 = 0.15;
const SMOOTHINGS: usize = 3;
/// Gaps wider than so many spacings get points in them, but no more than these: a spline cannot bend between two of its points.
const WIDE: f64 = 1.5;
const MOST_PARTS: f64 = 12.0;
/// Directions that cells tell apart: the two sides of a thin object are not one place.
const DIRECTIONS: f64 = 4.0;
/// Cosine between a step and the tangents at its ends below which it is dearer, and by how much.
const AHEAD: f64 = 0.3;
const ASTRAY: f64 = 4.0;
/// Way by which the contour goes straight on beyond the first and the last contact, rod lengths.
const BEYOND: f64 = 0.15;

/// A place that was touched: where, in which direction the contour goes there, and its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touched {
    pub at: Vector2<f64>,
    pub along: Vector2<f64>,
    pub weight: f64,
}

/// Points along the contour, in its direction, with the solid on the left; none where fewer than two places were touched.
///
/// `is_sure` says that the points are answers; others are as noise left them: then strays are left out and zigzags smoothed.
pub(super) fn outline(touched: &[Touched], is_sure: bool) -> Option<Vec<Vector2<f64>>> {
    let places = cells(touched);
    let mut ordered = in_order(&places);
    if !is_sure {
        ordered = without_strays(ordered);
    }
    ordered = thinned(ordered);
    if !is_sure {
        ordered = smoothed(ordered);
    }
    if ordered.len() < 2 {
        // one place alone: a straight line through it
        let one = places.first()?;
        ordered = vec![one.at - one.along * 0.5 * SPACING, one.at + one.along * 0.5 * SPACING];
    }
    ordered = filled(&ordered);
    let count = ordered.len();
    let from = (ordered[0] - ordered[1]).normalize() * BEYOND;
    let to = (ordered[count - 1] - ordered[count - 2]).normalize() * BEYOND;
    ordered.insert(0, ordered[0] + from);
    ordered.push(ordered[count] + to);
    Some(ordered)
}

/// Means of what lies in one cell and has about one direction.
fn cells(touched: &[Touched]) -> Vec<Touched> {
    let mut cells: BTreeMap<(i64, i64, i64), Touched> = BTreeMap::new();
    for one in touched {
        let turn = one.along.y.atan2(one.along.x) / std::f64::consts::TAU;
        let key = |v: f64| (v / SPACING).floor() as i64;
        let direction = (turn * DIRECTIONS + 0.5).floor().rem_euclid(DIRECTIONS) as i64;
        let nothing = Touched { at: Vector2::zeros(), along: Vector2::zeros(), weight: 0.0 };
        let cell = cells.entry((key(one.at.x), key(one.at.y), direction)).or_insert(nothing);
        cell.at += one.at * one.weight;
        cell.along += one.along * one.weight;
        cell.weight += one.weight;
    }
    let mean = |cell: &Touched| {
        let along = cell.along.try_normalize(1e-9 * cell.weight)?;
        Some(Touched { at: cell.at / cell.weight, along, weight: cell.weight })
    };
    cells.values().filter_map(mean).collect()
}

/// Greedy ordering: joins the cheapest pairs first, without branching or closing. A step from one place to another costs its length, and
/// more where it does not go the way of the contour.
fn in_order(places: &[Touched]) -> Vec<Vector2<f64>> {
    let count = places.len();
    let cost = |i: usize, j: usize| {
        let step = places[j].at - places[i].at;
        let length = step.norm();
        let astray = |along: &Vector2<f64>| (AHEAD - step.dot(along) / length.max(1e-12)).max(0.0);
        length * (1.0 + ASTRAY * (astray(&places[i].along) + astray(&places[j].along)))
    };
    let mut steps: Vec<(f64, usize, usize)> = (0..count)
        .flat_map(|i| (0..count).filter(move |j| *j != i).map(move |j| (i, j)))
        .map(|(i, j)| (cost(i, j), i, j))
        .collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut next, mut before) = (vec![None; count], vec![None; count]);
    // the path that each place belongs to
    let mut path: Vec<usize> = (0..count).collect();
    for (_, i, j) in steps {
        if next[i].is_none() && before[j].is_none() && path[i] != path[j] {
            (next[i], before[j]) = (Some(j), Some(i));
            let (from, to) = (path[j], path[i]);
            path.iter_mut().filter(|path| **path == from).for_each(|path| *path = to);
        }
    }
    let mut here = (0..count).find(|k| before[*k].is_none());
    let mut ordered = Vec::with_capacity(count);
    while let Some(k) = here {
        ordered.push(places[k].at);
        here = next[k];
    }
    ordered
}

/// Without a few points at an end that a long step parts from all others: noise threw them there.
fn without_strays(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    for _ in 0..2 {
        let is_far = |k: &usize| (points[k + 1] - points[*k]).norm() > STRAY_STEP * SPACING;
        let most = STRAYS.min(points.len() / 4);
        if let Some(cut) = (0..most).rev().find(is_far) {
            points.drain(..=cut);
        }
        points.reverse();
    }
    points
}

/// Each point but the ends at the mean of itself, twice, and its neighbours, where it leaves their line by more than a part of their distance: a
/// rod finds no equilibrium on a zigzag of noise.
fn smoothed(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    for _ in 0..SMOOTHINGS {
        let before = points.clone();
        for k in 1..points.len().saturating_sub(1) {
            let (a, b, c) = (before[k - 1], before[k], before[k + 1]);
            let middle = 0.5 * (a + c);
            if (b - middle).norm() > ZIGZAG * (c - a).norm() {
                points[k] = 0.5 * (b + middle);
            }
        }
    }
    points
}

/// Without points that lie too close to the one before.
fn thinned(points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    let mut kept: Vec<Vector2<f64>> = Vec::with_capacity(points.len());
    for point in points {
        if kept.last().is_none_or(|last| (point - last).norm() > CLOSE * SPACING) {
            kept.push(point);
        }
    }
    kept
}

/// With points between those of a wide gap, on the line that joins them.
fn filled(points: &[Vector2<f64>]) -> Vec<Vector2<f64>> {
    let mut filled = Vec::with_capacity(points.len());
    for pair in points.windows(2) {
        let parts = ((pair[1] - pair[0]).norm() / (WIDE * SPACING)).ceil().clamp(1.0, MOST_PARTS);
        let part = |k: usize| pair[0] + (pair[1] - pair[0]) * (k as f64 / parts);
        filled.extend((0..parts as usize).map(part));
    }
    filled.extend(points.last());
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_of_a_thin_plate_are_passed_in_order() {
        // from left to right below, and back above, at a thickness of a third of the spacing
        let side =
            |x: f64, y: f64, way: f64| Touched { at: Vector2::new(x, y), along: Vector2::new(way, 0.0), weight: 1.0 };
        let x = |k: usize| 0.005 * k as f64;
        let mut touched: Vec<Touched> = (0..100).map(|k| side(x(k), 0.0, 1.0)).collect();
        touched.extend((0..100).map(|k| side(x(k), 0.01, -1.0)));
        let ordered = outline(&touched, true).unwrap();
        let inner = &ordered[1..ordered.len() - 1];
        let turns = inner.windows(2).filter(|pair| pair[0].y != pair[1].y).count();
        assert_eq!(turns, 1, "{inner:?}");
        let on = |y: f64| inner.iter().filter(|point| point.y == y).map(|point| point.x).collect::<Vec<_>>();
        assert!(on(0.0).is_sorted() && on(0.01).iter().rev().is_sorted(), "{inner:?}");
    }
}
