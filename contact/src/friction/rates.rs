//! How fast and how far contacts slip along a branch.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::Tangent;
use crate::scene::world::World;
use rod_core::{Grip, Hold, Support, arc_length};

/// Rate of the slip coordinate by arclength of the branch in the wrong sense that is rounding. A contact that turns back at a rate of 1 (L)
/// per arclength is seen this far (L) behind.
const WRONG_WAY: f64 = 1e-10;

/// 1 where the rod runs in the sense of the contour at contact j, -1 where it runs against it.
fn sense(configuration: &Configuration, j: usize, support: &Support) -> f64 {
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

/// The contacts that slip against the sense of their friction, each with its f_t / f: they have stopped on the way here.
pub(crate) fn reversed_slips<'a>(
    world: &'a World<'_>,
    configuration: &'a Configuration,
    tangent: &'a Tangent,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    configuration.contacts.iter().enumerate().filter_map(|(j, held)| match held.grip {
        Grip::Slips { ratio } if ratio != 0.0 => {
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
