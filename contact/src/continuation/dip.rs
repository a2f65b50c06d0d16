//! Conditions of the contact set that hold at both ends of a step and are violated in between: found by the cubic through values and rates at
//! both ends.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::Tangent;
use crate::friction::{slip_between, slip_rate};
use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::scene::rod::Segment;
use crate::scene::world::World;
use crate::stability::{bends, clearance};
use rod_core::{Grip, PhysicalRod, Support};

/// Part of a step over which the rate of a clearance is computed as a difference quotient.
const NUDGE: f64 = 1e-4;

/// A quantity at both ends of a step, and its rates there times the length of the step.
#[derive(Clone, Copy)]
struct Course {
    ends: [f64; 2],
    rates: [f64; 2],
}

impl Course {
    /// This quantity times `own` plus another one times `others`.
    fn weighted_sum(&self, own: f64, others: f64, other: &Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [own * a[0] + others * b[0], own * a[1] + others * b[1]];
        Self { ends: sum(self.ends, other.ends), rates: sum(self.rates, other.rates) }
    }

    /// The value at which the tangents at both ends meet, if the quantity falls at the start and rises at the end. It is a lower bound of a convex
    /// course, with kinks or without.
    fn least_of_tangents(&self) -> Option<f64> {
        let Self { ends: [p, q], rates: [u, v] } = *self;
        (u < 0.0 && v > 0.0).then(|| p + u * (q - v - p) / (u - v))
    }

    /// Whether the cubic is not negative at the ends and is negative in between.
    fn dips(&self) -> bool {
        let Self { ends: [p, q], rates: [u, v] } = *self;
        // without a fall at the start and a rise at the end its least value is at an end
        if u >= 0.0 || v <= 0.0 {
            return false;
        }
        let room = LIMITS.course.error * (1.0 + p.abs().max(q.abs()));
        let (b, c) = (3.0 * (q - p) - 2.0 * u - v, u + v - 2.0 * (q - p));
        let value = |x: f64| p + x * (u + x * (b + x * c));
        // the root of its slope u + 2 b x + 3 c x^2 at which that rises
        let root = (b * b - 3.0 * c * u).max(0.0).sqrt();
        let lowest = if b >= 0.0 { -u / (b + root) } else { (root - b) / (3.0 * c) };
        p > -room && q > -room && value(lowest.clamp(0.0, 1.0)) < -room
    }
}

/// The least rate of the cubic with these rates at both ends and this mean rate. None where it is at an end.
pub(super) fn least_rate([first, last]: [f64; 2], mean: f64) -> Option<f64> {
    // first + x (linear + x square) with x from 0 to 1
    let (linear, square) = (6.0 * mean - 4.0 * first - 2.0 * last, 3.0 * (first + last) - 6.0 * mean);
    let lowest = -0.5 * linear / square;
    (square > 0.0 && (0.0..1.0).contains(&lowest)).then_some(first + 0.5 * linear * lowest)
}

/// Whether a rate is not negative at both ends of a step and is negative in between, by the cubic with this mean rate.
fn turns_back([first, last]: [f64; 2], mean: f64) -> bool {
    let room = LIMITS.course.error * (1.0 + first.abs().max(last.abs()));
    first > -room && last > -room && least_rate([first, last], mean).is_some_and(|least| least < -room)
}

/// Whether a contact would pull, leave its cone of friction or slip against its mode somewhere within a step, although it does not at its ends.
pub(super) fn dips(
    world: &World<'_>,
    (here, start): (&Configuration, &Tangent),
    (next, after): (&Configuration, &Tangent),
    length: f64,
) -> bool {
    let size = next.z.len();
    let stretch = start.component(&after.direction);
    let course = |i: usize| Course {
        ends: [here.z[i], next.z[i]],
        rates: [start.rate(i) * length, after.rate(i) / stretch * length],
    };
    (0..here.count()).any(|j| {
        let force = course(Unknown::Force(j).index(size));
        let rubs = match here.contacts[j].grip {
            Grip::SMOOTH => false,
            Grip::Slips { .. } if world.sliding() != 0.0 => false,
            Grip::Sticks { .. } => {
                let (friction, limit) =
                    (course(here.friction_index(j)), world.coefficients(here.contacts[j].stretch).at_rest);
                [1.0, -1.0].into_iter().any(|side| force.weighted_sum(limit, side, &friction).dips())
            }
            Grip::Slips { ratio } => {
                let forward = -ratio.signum();
                let rates = [slip_rate(world, here, start, j), slip_rate(world, next, after, j) / stretch];
                turns_back(rates.map(|rate| forward * rate), forward * slip_between(world, here, next, j) / length)
            }
        };
        rubs || force.dips()
    })
}

/// Whether the contour has a hollow, or a flat part between bumps, between the places of contact j at both ends of a step: halfway between them
/// it is less curved than `least` (1 / L), the lower curvature of the two.
fn flattens(world: &World<'_>, here: &Configuration, next: &Configuration, (j, least): (usize, f64)) -> bool {
    let halfway = || world.support(here.contacts[j].stretch, 0.5 * (here.t(j) + next.t(j)));
    least > 0.0 && {
        let Support { turning, speed, .. } = halfway();
        turning < LIMITS.course.flatter * least * speed
    }
}

/// Whether a contact might lie along a line somewhere within a step, although it does not at its ends. The clearance has kinks where the
/// curvature of a spline or of the rod has, so that no cubic describes it.
pub(super) fn may_lie_down<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    (here, start): (&Configuration, &Tangent),
    (next, after): (&Configuration, &Tangent),
    segments: [&[Segment]; 2],
    length: f64,
) -> bool {
    let stretch = start.component(&after.direction);
    (0..here.count()).any(|j| {
        let at_ends = [bends(setup, here, segments[0], j), bends(setup, next, segments[1], j)];
        let [Some(first), Some(last)] = at_ends else { return false };
        let ends = [first, last].map(|(contour, rod)| contour - rod);
        let [closer, farther] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let is_far = || {
            closer >= LIMITS.course.large_clearance.max(0.5 * farther)
                && !flattens(&setup.world, here, next, (j, first.0.min(last.0)))
        };
        if farther < LIMITS.course.error || is_far() {
            return false;
        }
        let beside = |at: Configuration| clearance(setup, &at, &at.segments(setup), j);
        let ahead = beside(start.ahead(here, NUDGE * length));
        let back = beside(after.ahead(next, -NUDGE * length / stretch));
        let rates = [ahead - ends[0], ends[1] - back].map(|change| change / NUDGE);
        Course { ends, rates }.least_of_tangents().is_some_and(|least| least < LIMITS.course.least_clearance * farther)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_that_touches_zero_does_not_dip() {
        let parabola = |least: f64| Course { ends: [least + 0.25; 2], rates: [-1.0, 1.0] };
        assert!(!parabola(0.0).dips() && !parabola(1e-3).dips() && parabola(-1e-3).dips());
        // (x - 1/4)^2 (x + 1), shifted
        let cubic = |least: f64| Course { ends: [least + 0.0625, least + 1.125], rates: [-0.4375, 3.5625] };
        assert!(!cubic(0.0).dips() && cubic(-1e-3).dips());
        // rising from zero, and falling to it
        assert!(!Course { ends: [0.0, 1.0], rates: [1.0, 1.0] }.dips());
        assert!(!Course { ends: [1.0, 0.0], rates: [-1.0, -1.0] }.dips());
    }

    #[test]
    fn a_rate_that_is_negative_in_the_middle_turns_back() {
        // r = 4 (x - 1/2)^2 - c leads 1/3 - c
        let turns = |c: f64| turns_back([1.0 - c; 2], 1.0 / 3.0 - c);
        assert!(!turns(0.0) && !turns(-0.1) && turns(0.01));
    }
    #[test]
    fn the_tangents_of_a_kink_tell_its_depth() {
        // |x - 1/4| + c, and what falls or rises only
        let kink = |c: f64| Course { ends: [0.25 + c, 0.75 + c], rates: [-1.0, 1.0] };
        assert!((kink(-0.01).least_of_tangents().unwrap() + 0.01).abs() < 1e-15);
        assert!((kink(0.02).least_of_tangents().unwrap() - 0.02).abs() < 1e-15);
        assert!(Course { ends: [1.0, 0.5], rates: [-1.0, -0.1] }.least_of_tangents().is_none());
    }
}
