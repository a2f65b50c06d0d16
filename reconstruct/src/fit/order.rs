//! The order of contact points along the contours.

use crate::numeric::wrap_angle;
use nalgebra::Vector2;
use std::collections::{BTreeMap, BTreeSet};

/// Two places closer than this share of the spacing are one, if they have about one direction.
const CLOSE: f64 = 0.4;
/// Angle between two directions, radians, up to which they are about one.
const SAME_TURN: f64 = 0.15;
/// Standard deviation of a contact point, rod lengths, up to which it is always used; the second where places are looked at sharply.
pub(super) const SURE: f64 = 0.01;
pub(super) const SHARPLY: f64 = 0.003;
/// One that is known worse is not used where a better one is within so many of its standard deviations.
const WITHIN: f64 = 3.0;
/// Directions that cells tell apart: both sides of a thin object, and the places along a sharp bend, are not one place.
const DIRECTIONS: f64 = 12.0;
/// What an angle between the directions of two places adds to the length of the step between them, rod lengths per radian.
const TURNING: f64 = 0.01;
/// How much more it adds where the contour is concave.
const CONCAVE: f64 = 3.0;
/// Largest distance of two places, rod lengths, at which the way from one to the other may have no direction: if noise alone might part them.
pub(super) const NO_WAY: f64 = 0.01;
/// Cosine between a step and the tangents at its ends below which it is dearer, and by how much.
const AHEAD: f64 = 0.3;
const ASTRAY: f64 = 4.0;
/// Longest step between two places of one object, rod lengths.
pub(super) const LONGEST: f64 = 0.36;

/// A place that was touched, in rod lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touched {
    pub at: Vector2<f64>,
    /// The direction in which the contour goes there.
    pub along: Vector2<f64>,
    /// Standard deviation of the place, across the contour and along it.
    pub sigma: f64,
    /// How much it counts where places are averaged.
    pub weight: f64,
    /// Number of the trace of one contact that it belongs to.
    pub trace: usize,
    /// The first of the samples that touched it.
    pub sample: usize,
}

impl Touched {
    pub fn alpha(&self) -> f64 {
        self.along.y.atan2(self.along.x)
    }
}

/// The points, the best known first, without those that are known worse than `sure` and have better ones near them: noise throws points at the
/// beginning of a contact along the rod.
pub(super) fn sure_enough(touched: &[Touched], sure: f64) -> Vec<Touched> {
    let mut order = touched.to_vec();
    order.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    // the first point of each cell, and the unsure ones that are kept
    let mut cells: BTreeMap<(i64, i64), Vector2<f64>> = BTreeMap::new();
    let mut unsure: Vec<Vector2<f64>> = Vec::new();
    order.retain(|point| {
        let is_near = |at: &Vector2<f64>| (at - point.at).norm() < WITHIN * point.sigma;
        if point.sigma <= sure {
            let cell = |v: f64| (v / sure).floor() as i64;
            cells.entry((cell(point.at.x), cell(point.at.y))).or_insert(point.at);
        } else if cells.values().chain(&unsure).any(is_near) {
            return false;
        } else {
            unsure.push(point.at);
        }
        true
    });
    order
}

/// What lies in one cell and has about one direction.
pub(super) struct Cell {
    /// The mean.
    place: Touched,
    traces: BTreeSet<usize>,
}

pub(super) fn cells(touched: &[Touched], spacing: f64) -> Vec<Cell> {
    let mut cells: BTreeMap<(i64, i64, i64), Cell> = BTreeMap::new();
    for one in touched {
        let key = |v: f64| (v / spacing).floor() as i64;
        let direction = (one.alpha() / std::f64::consts::TAU * DIRECTIONS + 0.5).floor().rem_euclid(DIRECTIONS) as i64;
        let at = (key(one.at.x), key(one.at.y), direction);
        let cell = cells.entry(at).or_insert_with(|| Cell { place: *one, traces: BTreeSet::new() });
        if !cell.traces.is_empty() {
            cell.place = mean(&[cell.place, *one]);
        }
        cell.traces.insert(one.trace);
    }
    cells.into_values().collect()
}

/// Chains of places by greedy ordering: joins the cheapest pairs first, without branching or closing. A step from one place to another costs its length, and
/// more where it does not go the way of the contour.
pub(super) fn in_order(
    cells: &[Cell],
    apart: f64,
    is_barred: impl Fn(Vector2<f64>, Vector2<f64>) -> bool,
) -> Vec<Vec<Touched>> {
    let count = cells.len();
    let cost = |i: usize, j: usize| {
        let (from, to) = (&cells[i], &cells[j]);
        let length = (to.place.at - from.place.at).norm();
        let is_far = length > apart && from.traces.is_disjoint(&to.traces) || length > LONGEST;
        (!is_far).then(|| dearness(&from.place, &to.place))
    };
    let mut steps: Vec<(f64, usize, usize)> = (0..count)
        .flat_map(|i| (0..count).filter(move |j| *j != i).map(move |j| (i, j)))
        .filter_map(|(i, j)| Some((cost(i, j)?, i, j)))
        .collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut next, mut before) = (vec![None; count], vec![None; count]);
    // the path that each place belongs to
    let mut path: Vec<usize> = (0..count).collect();
    for (_, i, j) in steps {
        if next[i].is_none()
            && before[j].is_none()
            && path[i] != path[j]
            && !is_barred(cells[i].place.at, cells[j].place.at)
        {
            (next[i], before[j]) = (Some(j), Some(i));
            let (from, to) = (path[j], path[i]);
            path.iter_mut().filter(|path| **path == from).for_each(|path| *path = to);
        }
    }
    let chain = |first: usize| std::iter::successors(Some(first), |k| next[*k]).map(|k| cells[k].place).collect();
    (0..count).filter(|k| before[*k].is_none()).map(chain).collect()
}

/// What a step from one place to another costs.
pub(super) fn dearness(from: &Touched, to: &Touched) -> f64 {
    let step = to.at - from.at;
    let length = step.norm();
    let astray = |along: &Vector2<f64>| (AHEAD - step.dot(along) / length.max(1e-12)).max(0.0);
    let turn = wrap_angle(to.alpha() - from.alpha());
    // the way between places that noise alone might part has no direction; a rod that lies there tells of convex bends
    let by_noise = (WITHIN * from.sigma.hypot(to.sigma)).min(NO_WAY);
    let known = (length - by_noise).max(0.0);
    let turning = if turn < 0.0 { -CONCAVE * turn } else { turn };
    length + known * ASTRAY * (astray(&from.along) + astray(&to.along)) + TURNING * turning
}

/// Without chains that lie beside heavier ones along all of their places: cells that the ordering has passed by.
pub(super) fn without_doubles(chains: &mut Vec<Vec<Touched>>, spacing: f64) {
    chains.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    let mut kept: Vec<Touched> = Vec::new();
    chains.retain(|chain| {
        let is_beside = |place: &Touched| {
            kept.iter().any(|other| (other.at - place.at).norm() < spacing && other.along.dot(&place.along) > 0.0)
        };
        let is_double = chain.iter().all(is_beside);
        if !is_double {
            kept.extend(chain);
        }
        !is_double
    });
}

pub(super) fn weight(chain: &[Touched]) -> f64 {
    chain.iter().map(|place| place.weight).sum()
}

/// Places that lie too close to the one before, with about its direction, as one.
pub(super) fn merged(chain: Vec<Touched>, spacing: f64) -> Vec<Touched> {
    let mut kept: Vec<Touched> = Vec::with_capacity(chain.len());
    for place in chain {
        let turn = |last: &Touched| wrap_angle(place.alpha() - last.alpha()).abs();
        match kept.last_mut() {
            Some(last) if (place.at - last.at).norm() < CLOSE * spacing && turn(last) < SAME_TURN => {
                *last = mean(&[*last, place]);
            }
            _ => kept.push(place),
        }
    }
    kept
}

pub(super) fn mean(places: &[Touched]) -> Touched {
    let weight: f64 = places.iter().map(|place| place.weight).sum();
    let of = |value: fn(&Touched) -> Vector2<f64>| {
        places.iter().map(|place| value(place) * (place.weight / weight)).sum::<Vector2<f64>>()
    };
    let along = of(|place| place.along);
    Touched { at: of(|place| place.at), along: along.try_normalize(1e-9).unwrap_or(along), weight, ..places[0] }
}
