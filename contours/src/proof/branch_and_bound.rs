//! The closest point of a curve of which limits are known: branch and bound, exact to rounding.
//!
//! On a part no longer than l, seen from p with `w = r - p`, let `phi = w . T` and `h = w . N`. By arc length
//! `d(|w|^2)/ds = 2 phi`, `d phi/ds = 1 + kappa h`, `dh/ds = -kappa phi`. Where `1 + kappa h > 0` throughout, the part has
//! one foot at most; elsewhere the distance has lower bounds of first and of second order. A part whose bound is not below
//! the distance found is passed over, one with a single foot is left to Newton's iteration, any other is halved.

use super::limits::Limits;
use crate::nearest::search::zero;
use crate::point::{cross, dot};
use crate::{Point, Range, Vector};

/// Largest number of parts for one point. Tight limits need some tens; limits that do not tighten on smaller parts end here.
const MOST: usize = 200_000;

/// Halvings of a range, down to rounding.
const HALVINGS: u32 = 52;

/// Rounding of a distance, relative to the lengths that it is computed from. Closer points are not searched for.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Least value of `1 + kappa h` that proves that there is one foot: above what its rounding can be.
const CERTAIN: f64 = 1e-9;

/// Rounds in which the bounds of `phi` and `h` tighten each other.
const ROUNDS: usize = 3;

/// The values at one parameter.
#[derive(Clone, Copy)]
struct Place {
    t: f64,
    distance: f64,
    /// `w . dr/dt` and its derivative.
    slope: f64,
    rate: f64,
    phi: f64,
    h: f64,
}

impl Place {
    fn new(t: f64, [at, velocity, acceleration]: [Vector; 3], [x, y]: Point) -> Self {
        let way = [at[0] - x, at[1] - y];
        let speed = velocity[0].hypot(velocity[1]);
        let slope = dot(way, velocity);
        Self {
            t,
            distance: way[0].hypot(way[1]),
            slope,
            rate: dot(velocity, velocity) + dot(way, acceleration),
            phi: slope / speed,
            h: cross(velocity, way) / speed,
        }
    }
}

/// The parameter of the point of the part in `range` that is nearest to `point`; of several, one. `derivatives` gives
/// r, dr/dt and its derivative.
pub(crate) fn closest_parameter(
    derivatives: impl Fn(f64) -> [Vector; 3],
    limits: impl Fn(Range) -> Limits,
    range: Range,
    point: Point,
) -> f64 {
    let place = |t: f64| Place::new(t, derivatives(t), point);
    let (first, last) = (place(range.from), place(range.to));
    let mut best = if last.distance < first.distance { last } else { first };
    let size = point[0].abs().max(point[1].abs());
    let mut open = vec![(first, last, HALVINGS)];
    let mut looked = 0;
    while let Some((left, right, halvings)) = open.pop() {
        looked += 1;
        let part = Range { from: left.t, to: right.t };
        let known = PartBounds::new(left, right, limits(part));
        if halvings == 0 || looked > MOST || known.least >= best.distance - ROUNDING * (best.distance + size) {
            continue;
        }
        if known.turns > CERTAIN {
            if left.slope < 0.0 && right.slope >= 0.0 {
                let foot = foot(&place, left, right);
                if foot.distance <= best.distance {
                    best = foot;
                }
            }
            continue;
        }
        let middle = place(part.at(0.5));
        if middle.distance < best.distance {
            best = middle;
        }
        let mut halves = [(left, middle, halvings - 1), (middle, right, halvings - 1)];
        // The nearer half is looked at first.
        if left.distance < right.distance {
            halves.reverse();
        }
        open.extend(halves);
    }
    best.t
}

/// Bounds on a part between two places.
struct PartBounds {
    /// Lower bound of the distance.
    least: f64,
    /// Lower bound of `1 + kappa h`.
    turns: f64,
}

impl PartBounds {
    fn new(left: Place, right: Place, limits: Limits) -> Self {
        let length = limits.speed * (right.t - left.t);
        let (low, high) = limits.curvature;
        let most = low.abs().max(high.abs());
        let first_order = 0.5 * (left.distance + right.distance - length);
        if !(length.is_finite() && most.is_finite()) {
            return Self { least: if first_order.is_nan() { 0.0 } else { first_order }, turns: f64::NEG_INFINITY };
        }
        // Every place is within half the length of an end.
        let half = 0.5 * length;
        let farthest = 0.5 * (left.distance + right.distance + length);
        let mut phi = farthest;
        let mut least = f64::NEG_INFINITY;
        for _ in 0..ROUNDS {
            let off = most * phi * half;
            let h = [(left.h.min(right.h) - off).max(-farthest), (left.h.max(right.h) + off).min(farthest)];
            let rates = [low * h[0], low * h[1], high * h[0], high * h[1]].map(|product| 1.0 + product);
            least = rates.iter().copied().fold(f64::INFINITY, f64::min);
            let fastest = rates.iter().fold(0.0, |fastest: f64, rate| fastest.max(rate.abs()));
            phi = phi.min(left.phi.abs().max(right.phi.abs()) + fastest * half);
        }
        // d^2(|w|^2)/ds^2 = 2 (1 + kappa h); concave lower bounds are least at their ends.
        let sag = (-least).max(0.0) * half * half;
        let from_left = left.distance.powi(2) + (2.0 * left.phi * half - sag).min(0.0);
        let from_right = right.distance.powi(2) + (-2.0 * right.phi * half - sag).min(0.0);
        let second_order = from_left.min(from_right).max(0.0).sqrt();
        Self { least: first_order.max(second_order), turns: least }
    }
}

/// The zero of the slope between two places, to rounding.
fn foot(place: &impl Fn(f64) -> Place, left: Place, right: Place) -> Place {
    let mut here = if -left.slope < right.slope { left } else { right };
    let resolution = f64::EPSILON * left.t.abs().max(right.t.abs());
    zero(Range { from: left.t, to: right.t }, here.t, resolution, |t| {
        if t != here.t {
            here = place(t);
        }
        [here.slope, here.rate]
    });
    here
}
