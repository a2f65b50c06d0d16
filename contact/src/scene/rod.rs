//! The rod between its contacts, dimensionless, of any model.

use rod_core::{Cut, Pose, RodModel, Station};
use std::f64::consts::PI;

/// A part of the rod between two contacts, along which the force is constant.
pub(crate) type Segment = rod_core::Segment<Cut>;

/// The rod at its base, where the clamp feels the moment `m0z`.
pub(crate) fn at_clamp(Pose { x, y, phi }: Pose, m0z: f64) -> Cut {
    Cut { x, y, phi, moment: -m0z }
}

/// What a contact with the tangent angle `alpha` adds to (A, B) by its normal force and its force along the contour.
pub(crate) fn push(force: f64, friction: f64, alpha: f64) -> (f64, f64) {
    let (sin, cos) = alpha.sin_cos();
    (force * cos - friction * sin, force * sin + friction * cos)
}

/// The rod at an arc length of one of its segments.
#[inline(always)]
pub(crate) fn at(rod: &impl RodModel, segment: &Segment, s: f64) -> Cut {
    rod.carry(segment.s, &segment.start, segment.a, segment.b, s - segment.s)
}

/// The rod at an arc length.
pub(crate) fn along(rod: &impl RodModel, segments: &[Segment], s: f64) -> Cut {
    at(rod, &segments[segments.partition_point(|segment| segment.s <= s).saturating_sub(1)], s)
}

/// The rod walked from the clamp, contact by contact, under the force that it carries there.
pub(crate) struct Walk<'a, M> {
    rod: &'a M,
    s: f64,
    at: Cut,
    force: (f64, f64),
}

impl<'a, M: RodModel> Walk<'a, M> {
    /// From the clamp with the force (A, B) on the first segment.
    pub fn new(rod: &'a M, clamp: Cut, force: (f64, f64)) -> Self {
        Self::beyond(rod, 0.0, clamp, force)
    }

    /// From the cut at arc length `s`, on a segment that carries the force (A, B).
    pub fn beyond(rod: &'a M, s: f64, at: Cut, force: (f64, f64)) -> Self {
        Self { rod, s, at, force }
    }

    /// Goes on to a contact at arc length `s`, that adds `push` to (A, B): the slope angle of the rod there.
    pub fn to(&mut self, s: f64, push: (f64, f64)) -> f64 {
        let (a, b) = self.force;
        self.at = self.rod.carry(self.s, &self.at, a, b, s - self.s);
        self.s = s;
        self.force = (a - push.0, b - push.1);
        self.at.phi
    }
}

/// How far at most the rod leaves the chord between two points of a segment, each with its arc length: by 1/8 of the square of their
/// distance times the largest curvature.
#[inline(always)]
pub(crate) fn bulge(rod: &impl RodModel, from: (f64, &Station), to: (f64, &Station), force: f64) -> f64 {
    let length = to.0 - from.0;
    let bent = if rod.is_uniform() {
        // it changes no faster than by the force: a cheap bound, hardly worse
        from.1.moment.abs().max(to.1.moment.abs()) + 0.5 * force * length
    } else {
        let (least, largest) = rod.curvature_bounds((from.0, from.1.moment), (to.0, to.1.moment), force);
        least.abs().max(largest.abs())
    };
    0.125 * length * length * bent
}

/// How fast the phase of the elastica grows at most along a segment under a force: sqrt(force / E I), rad a length.
#[inline(always)]
pub(crate) fn phase_rate(rod: &impl RodModel, from: f64, to: f64, force: f64) -> f64 {
    (force / rod.least_stiffness(from, to)).sqrt()
}

/// Parts of a segment on each of which its least stiffness stands for it.
const PARTS: usize = 8;

/// Whether a segment does not buckle between its ends under a force, both ends clamped in angle: force < E I (pi / length)^2, or the same for
/// a stiffness that varies.
///
/// By Sturm's comparison theorem it does not where the solution of (e eta')' = -force eta that vanishes at one end has no other zero, with
/// a stiffness e that is nowhere larger than that of the rod: the least one of each part.
#[inline(always)]
pub(crate) fn holds_between_ends(rod: &impl RodModel, from: f64, to: f64, force: f64) -> bool {
    let length = to - from;
    length > 0.0
        && (force * length * length < PI * PI * rod.least_stiffness(from, to)
            || (!rod.is_uniform() && holds_by_parts(rod, from, length / PARTS as f64, force)))
}

/// The same by parts of this length.
#[inline(never)]
fn holds_by_parts(rod: &impl RodModel, from: f64, length: f64, force: f64) -> bool {
    let (mut turn, mut moment) = (0.0, 1.0);
    (0..PARTS).all(|k| {
        let stiffness = rod.least_stiffness(from + length * k as f64, from + length * (k + 1) as f64);
        let resistance = (force * stiffness).sqrt();
        let phase = length * (force / stiffness).sqrt();
        let (sin, cos) = phase.sin_cos();
        (turn, moment) = (turn * cos + moment / resistance * sin, moment * cos - turn * resistance * sin);
        // less than half of a wave has one zero at most, which shows at its end
        phase < PI && turn > 0.0
    })
}

/// Number of segments before the one that leads to the first of so many contacts: 1 where the rod runs through a roller.
#[inline(always)]
pub(crate) fn lead(segments: &[Segment], contacts: usize) -> usize {
    segments.len() - 1 - contacts
}

/// Curvature of the rod right behind contact `j` of so many.
#[inline(always)]
pub(crate) fn curvature_behind(rod: &impl RodModel, segments: &[Segment], (j, contacts): (usize, usize)) -> f64 {
    let behind = &segments[j + 1 + lead(segments, contacts)];
    rod.curvature_at(behind.s, behind.start.moment)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{Cone, Smooth};

    #[test]
    fn a_cone_is_proven_to_hold_up_to_most_of_its_critical_load() {
        // the least stiffness of each eighth leaves 0.915, 0.841 and 0.637 of it
        for (taper, proven) in [(0.3, 0.9), (0.5, 0.8), (0.8, 0.6)] {
            let cone = Smooth::new(Cone { taper }).unwrap();
            // pressed along its axis, a turn that begins at the clamp has another zero at the tip first under the critical load
            let turn = |force: f64| {
                let straight = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 };
                cone.carry_with_sensitivities(0.0, &straight, 0.0, -force, 1.0).1.by_moment[2]
            };
            let (mut low, mut high) = (0.0, PI * PI);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                // the first of its zeros: below it the turn is positive all along
                if (1..=20).all(|k| turn(middle * f64::from(k) / 20.0) > 0.0) { low = middle } else { high = middle }
            }
            assert!(low > 1.5 * PI * PI * cone.least_stiffness(0.0, 1.0), "{taper}: {low}");
            assert!(holds_between_ends(&cone, 0.0, 1.0, proven * low) && !holds_between_ends(&cone, 0.0, 1.0, low));
        }
    }
}
