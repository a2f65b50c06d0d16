//! Coulomb friction: which contacts slip, stick or roll, and when that changes.
//!
//! The contact of the rod has gone a along the contour and s along the rod, which runs in the sense o = 1 of the contour or against it. The
//! slip coordinate g = a + o (1 - s) grows as the material point of the rod at the contact moves along the contour; it is constant where the rod sticks
//! (tip) or rolls (side). With the normal force f >= 0 and the force f_t on the rod along the contour:
//!
//! | mode | equation | holds while |
//! |---|---|---|
//! | slip+: g grows | f_t = -mu f | dg >= 0 |
//! | slip-: g falls | f_t = mu f | dg <= 0 |
//! | stick | g as it was | abs f_t <= mu f |
//!
//! A contact set that is `SMOOTH` throughout is one without friction, or one whose friction has not been decided yet.

pub(crate) mod law;
mod modes;
pub(crate) mod sliding;

pub use law::{Coefficients, Friction};

pub(crate) use modes::{Motion, UNLOADED, possible_motions, resists, without_unloaded};

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::scene::world::World;
use rod_core::{Grip, Hold, PhysicalRod, Support, arc_length};

/// Rate of the slip coordinate by arclength of the branch in the wrong sense that is rounding. A contact that turns back at a rate of 1 (L)
/// per arclength is seen this far (L) behind.
const WRONG_WAY: f64 = 1e-10;

/// 1 where the rod runs in the sense of the contour at contact j, -1 where it runs against it.
pub(crate) fn sense(configuration: &Configuration, j: usize, support: &Support) -> f64 {
    match configuration.contacts[j].hold {
        Hold::Tangent { offset } => 1.0_f64.copysign(offset.cos()),
        Hold::Tip => 1.0_f64.copysign((configuration.slope(j) - support.alpha).cos()),
    }
}

/// The change of the slip coordinate of contact j along a branch.
pub(crate) fn slip_rate(world: &World<'_>, configuration: &Configuration, tangent: &Tangent, j: usize) -> f64 {
    let support = world.support(configuration.contacts[j].stretch, configuration.t(j));
    let along = support.speed * tangent.rate_of(Unknown::Parameter(j));
    if configuration.is_tip(j) {
        return along;
    }
    along - sense(configuration, j, &support) * tangent.rate_of(Unknown::ArcLength(j))
}

/// How far (L) contact j has slipped from one point of a branch to another.
pub(crate) fn slip_between(world: &World<'_>, from: &Configuration, to: &Configuration, j: usize) -> f64 {
    let stretch = from.contacts[j].stretch;
    let along = arc_length(|t| world.support(stretch, t).speed, from.t(j), to.t(j));
    if from.is_tip(j) {
        return along;
    }
    along - sense(from, j, &world.support(stretch, from.t(j))) * (to.s(j) - from.s(j))
}

/// The contacts that slip against the sense of their friction, each with its f_t / f: they have stopped on the way here. None of a rod whose contacts
/// [slide](sliding) whatever their motion.
pub(crate) fn reversed_slips<'a>(
    world: &'a World<'_>,
    configuration: &'a Configuration,
    tangent: &'a Tangent,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    configuration.contacts.iter().enumerate().filter_map(|(j, held)| match held.grip {
        Grip::Slips { ratio } if ratio != 0.0 && world.sliding() == 0.0 => {
            (ratio.signum() * slip_rate(world, configuration, tangent, j) > WRONG_WAY).then_some((j, ratio))
        }
        _ => None,
    })
}

/// The slip coordinate g (L) of contact j: arc length of the contour from parameter 0 of its stretch, or from its start, less that of
/// the rod from its tip, in the contour's sense. At the tip that is none, whichever sense the rod has there.
pub(crate) fn slip_coordinate(world: &World<'_>, configuration: &Configuration, j: usize) -> f64 {
    let stretch = configuration.contacts[j].stretch;
    let (range, t) = (world.range(stretch), configuration.t(j));
    let support = world.support(stretch, t);
    let along = arc_length(|t| world.support(stretch, t).speed, range.clamp(0.0), t);
    along + sense(configuration, j, &support) * (1.0 - configuration.s(j))
}

/// Gauss-Legendre points and weights on (0, 1), order 12.
const POINTS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_54, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// int sum_j |f_t dg| along the branch from `from`, whose tangent is given, to `to` (E I / L). None where a point on the way is not found.
pub(crate) fn friction_work<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    (from, tangent): (&Configuration, &Tangent),
    to: &Configuration,
) -> Option<f64> {
    let slips = |j: usize| from.friction(j) != 0.0 && !from.contacts[j].grip.sticks();
    if from.contacts != to.contacts
        || !(0..to.count()).any(|j| slips(j) || (!to.contacts[j].grip.sticks() && to.friction(j) != 0.0))
    {
        return Some(0.0);
    }
    let whole = tangent.along(&to.z, &from.z);
    let mut sum = 0.0;
    for (share, weight) in POINTS {
        let distance = share * whole;
        let mut here = from.clone();
        for (z, end) in here.z.iter_mut().zip(&to.z) {
            *z += share * (end - *z);
        }
        let plane = Condition::Plane { tangent, from: &from.z, distance };
        if !corrector.correct(&mut here, plane).status.is_solved() {
            return None;
        }
        let (there, _) = corrector.inspect(&here, plane);
        let stretch = tangent.component(&there.direction);
        let world = &corrector.setup.world;
        let power = (0..here.count())
            .filter(|j| !here.contacts[*j].grip.sticks())
            .map(|j| -here.friction(j) * slip_rate(world, &here, &there, j) / stretch);
        sum += weight * whole * power.sum::<f64>();
    }
    Some(sum)
}
