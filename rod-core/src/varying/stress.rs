//! The bending stress at the surface of a round rod whose diameter varies.

use super::cones::{Cones, Frustum};
use crate::model::{Cut, RodModel};
use crate::segment::Segment;
use core::f64::consts::PI;
use smallvec::{SmallVec, smallvec};

/// Part of the largest stress by which the one that is found may be too small. Smaller: one more cut around a maximum between the ends of a
/// segment.
const ACCURACY: f64 = 1e-10;
/// Least share of an interval in a cut.
const LEAST_SHARE: f64 = 0.01;
/// Most intervals of a piece of a segment that are looked at. A maximum takes about ten.
const MOST_INTERVALS: usize = 4096;

/// The diameters (m) of a round rod along it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Diameters {
    /// It falls linearly: `clamp` (1 - `taper` s).
    Cone { clamp: f64, taper: f64 },
    /// It falls or grows linearly between points: `clamp` times that of the cones.
    Cones { clamp: f64, cones: Cones },
    /// One for each section; `joints` are the arc lengths between them.
    Sections { joints: Vec<f64>, diameters: Vec<f64> },
}

/// The stress of a unit of moment: 32 / (pi d^3) at the arc length `s`, d in m, and how fast that varies.
struct Modulus(Frustum);

impl Modulus {
    fn inverse(&self, s: f64) -> f64 {
        32.0 / (PI * self.0.at(s).powi(3))
    }

    /// Logarithmic derivative of the diameter, less its sign.
    fn narrowing(&self, s: f64) -> f64 {
        let Frustum { from, taper, .. } = self.0;
        taper / (1.0 - taper * (s - from))
    }
}

/// A place of a segment.
#[derive(Clone, Copy)]
struct Place {
    s: f64,
    cut: Cut,
    /// Derivatives of the moment by s and by the angle.
    along: f64,
    across: f64,
    /// Stress of a unit of moment, and by what part the diameter falls.
    inverse: f64,
    narrowing: f64,
    /// Stress, and its first two derivatives by s.
    stress: f64,
    rate: f64,
    bend: f64,
}

impl Diameters {
    /// The diameter at an arc length (L); at a joint that on the side of the tip.
    pub fn at(&self, s: f64) -> f64 {
        self.modulus(s).0.at(s)
    }

    /// That of the piece of a place; at a joint that on the side of the tip.
    fn modulus(&self, s: f64) -> Modulus {
        Modulus(match self {
            Self::Cone { clamp, taper } => Frustum { from: 0.0, diameter: *clamp, taper: *taper },
            Self::Cones { clamp, cones } => {
                let part = cones.part(s);
                Frustum { diameter: clamp * part.diameter, ..*part }
            }
            Self::Sections { joints, diameters } => {
                let piece = joints.partition_point(|&joint| joint <= s);
                Frustum { from: 0.0, diameter: diameters[piece], taper: 0.0 }
            }
        })
    }

    fn joints(&self) -> &[f64] {
        match self {
            Self::Cone { .. } => &[],
            Self::Cones { cones, .. } => &cones.joints,
            Self::Sections { joints, .. } => joints,
        }
    }

    /// |moment| 32 / (pi d^3) at an arc length, the moment in E I / L; at a joint on the side of the tip.
    pub fn stress(&self, s: f64, moment: f64) -> f64 {
        moment.abs() * self.modulus(s).inverse(s)
    }

    /// The largest |moment| 32 / (pi d^3) along a segment of a rod of this model that ends at arc length `to`, moments in E I / L. The cut there
    /// is `last`; without one the segment is free, and its moment the same all along. Or `least`, if that is larger: it spares the search where
    /// all is less.
    pub fn largest_stress<M: RodModel + ?Sized>(
        &self,
        model: &M,
        segment: &Segment<Cut>,
        (to, last): (f64, Option<&Cut>),
        least: f64,
    ) -> f64 {
        let Segment { s: from, start, a, b } = *segment;
        if start.moment.is_nan() {
            return f64::NAN;
        }
        // a contact set that is wrong has contacts beyond the tip, or in another order: nothing of the rod is there
        if to <= from {
            return least;
        }
        let ends = self.joints().iter().copied().filter(|joint| *joint > from && *joint < to).chain([to]);
        let (mut largest, mut left) = (least, (from, start));
        for end in ends {
            let modulus = self.modulus(left.0);
            let Some(last) = last else {
                let most = modulus.inverse(left.0).max(modulus.inverse(end));
                largest = largest.max(start.moment.abs() * most);
                left.0 = end;
                continue;
            };
            let cut = if end < to { model.carry(left.0, &left.1, a, b, end - left.0) } else { *last };
            let right = (end, cut);
            largest = largest_in_piece(model, &modulus, [a, b], [left, right], largest);
            left = right;
        }
        largest
    }
}

/// The largest stress between two places without a joint between them, or `least` if that is larger; NaN where a moment is NaN.
///
/// Branch and bound: an interval that may hold more than the largest value so far is cut in two, about where the stress is largest.
fn largest_in_piece<M: RodModel + ?Sized>(
    model: &M,
    modulus: &Modulus,
    [a, b]: [f64; 2],
    ends: [(f64, Cut); 2],
    least: f64,
) -> f64 {
    let place = |(s, cut): (f64, Cut)| {
        let (inverse, narrowing, (sin, cos)) = (modulus.inverse(s), modulus.narrowing(s), cut.phi.sin_cos());
        let (along, across) = (a * cos + b * sin, b * cos - a * sin);
        let rate = inverse * (3.0 * narrowing * cut.moment + along);
        let of_moment = 12.0 * narrowing * narrowing * cut.moment + 6.0 * narrowing * along;
        let bend = inverse * (of_moment + model.curvature_at(s, cut.moment) * across);
        Place { s, cut, along, across, inverse, narrowing, stress: inverse * cut.moment, rate, bend }
    };
    let [first, last] = ends.map(place);
    // what is NaN stays so
    let larger = |most: f64, place: &Place| {
        if most.is_nan() || place.stress.abs() <= most { most } else { place.stress.abs() }
    };
    let mut largest = larger(larger(least, &first), &last);
    let mut open: SmallVec<[(Place, Place); 4]> = smallvec![(first, last)];
    for _ in 0..MOST_INTERVALS {
        let Some((left, right)) = open.pop() else { break };
        // not where something is NaN
        let may_exceed = bound(model, [a, b], &left, &right) > largest * (1.0 + ACCURACY);
        let h = right.s - left.s;
        let share =
            extremum([left.rate, right.rate], [left.bend * h, right.bend * h], (right.stress - left.stress) / h);
        let share = share.map_or(0.5, |share| share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE));
        let at = left.s + share * h;
        if !may_exceed || at <= left.s || at >= right.s {
            continue;
        }
        let middle = place((at, model.carry(left.s, &left.cut, a, b, at - left.s)));
        largest = larger(largest, &middle);
        // the half that ends in the larger value first: it is what the other one has to exceed
        let halves = [(left, middle), (middle, right)];
        if left.stress.abs() > right.stress.abs() {
            open.extend(halves.into_iter().rev());
        } else {
            open.extend(halves);
        }
    }
    largest
}

/// The share of a way at which the function with these rates of opposite signs at its ends, these changes of the rate, taken over the way, and
/// this mean rate is stationary: of the cubic through the rates, and then, by Newton's method, of the quintic through all.
fn extremum([first, last]: [f64; 2], [leaves, arrives]: [f64; 2], mean: f64) -> Option<f64> {
    let (square, linear) = (3.0 * (first + last) - 6.0 * mean, 6.0 * mean - 4.0 * first - 2.0 * last);
    let root = (linear * linear - 4.0 * square * first).max(0.0).sqrt();
    let sum = -0.5 * (linear + root.copysign(linear));
    let within = |share: &f64| (0.0..=1.0).contains(share);
    let rough = [first / sum, sum / square].into_iter().find(|share| first * last <= 0.0 && within(share))?;
    // the rate is first + leaves t + c2 t^2 + c3 t^3 + c4 t^4
    let c4 = 30.0 * mean - 15.0 * (first + last) - 2.5 * (leaves - arrives);
    let c2 = 3.0 * (last - first) - 2.0 * leaves - arrives + c4;
    let c3 = 2.0 * (first - last) + leaves + arrives - 2.0 * c4;
    let share = (0..2).fold(rough, |t, _| {
        let rate = first + t * (leaves + t * (c2 + t * (c3 + t * c4)));
        t - rate / (leaves + t * (2.0 * c2 + t * (3.0 * c3 + 4.0 * t * c4)))
    });
    Some(if within(&share) { share } else { rough })
}

/// What the stress does not exceed between two places, without a joint between them.
///
/// With g = w m, w = 32 / (pi d^3) and n = -d' / d it is g'' = w (12 n^2 m + 6 n m' + m''), m' = A cos phi + B sin phi and
/// m'' = kappa (B cos phi - A sin phi). No place is farther than half of the interval from an end, so that the values at the ends, the force
/// and the curvature bound each factor.
fn bound<M: RodModel + ?Sized>(model: &M, [a, b]: [f64; 2], left: &Place, right: &Place) -> f64 {
    let (h, force) = (right.s - left.s, a.hypot(b));
    let kappa = model.curvature_bounds((left.s, left.cut.moment), (right.s, right.cut.moment), force);
    let turn = 0.5 * h * kappa.0.abs().max(kappa.1.abs());
    let around = |one: f64, other: f64, slack: f64| (one.min(other) - slack, one.max(other) + slack);
    let moment = around(left.cut.moment, right.cut.moment, 0.5 * h * force);
    let rate = around(left.along, right.along, turn * force);
    let bend = product(kappa, around(left.across, right.across, turn * force));
    let narrowing = around(left.narrowing, right.narrowing, 0.0);
    let square = product(narrowing, narrowing);
    let (of_moment, of_rate) = (product((12.0 * square.0.max(0.0), 12.0 * square.1), moment), product(narrowing, rate));
    let second = (of_moment.0 + 6.0 * of_rate.0 + bend.0, of_moment.1 + 6.0 * of_rate.1 + bend.1);
    let second = product(second, around(left.inverse, right.inverse, 0.0));
    let ends = |sign: f64| [left, right].map(|place| (sign * place.stress, sign * place.rate));
    highest(ends(1.0), h, second.1).max(highest(ends(-1.0), h, -second.0))
}

/// What a function with these values and rates at both ends of a way `h`, and a second derivative of at most `second`, does not exceed. It is below
/// the parabolas with this second derivative from both ends, which meet once.
fn highest([(g0, d0), (g1, d1)]: [(f64, f64); 2], h: f64, second: f64) -> f64 {
    let meet = (g1 - g0 - d1 * h + 0.5 * second * h * h) / (d0 - d1 + second * h);
    let meet = if meet.is_nan() { 0.0 } else { meet.clamp(0.0, h) };
    // each one is largest at one of its ends, or, if it bends down, at its top
    let part = |g: f64, d: f64, way: f64| {
        let top = -d / second;
        let top = if second < 0.0 && top > 0.0 && top < way { g + 0.5 * d * top } else { g };
        top.max(g + way * (d + 0.5 * second * way))
    };
    part(g0, d0, meet).max(part(g1, -d1, h - meet))
}

/// The range of a product of numbers of two ranges.
fn product((a0, a1): (f64, f64), (b0, b1): (f64, f64)) -> (f64, f64) {
    let all = [a0 * b0, a0 * b1, a1 * b0, a1 * b1];
    all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(*value), most.max(*value)))
}
