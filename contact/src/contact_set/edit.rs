//! Changes of a contact set: they move a contact onto the next stretch or the tip to the other side of a corner, and turn a tip contact into a
//! tangential one or the reverse.

use crate::contact_set::{ActiveContact, Configuration, FORCE_TOLERANCE, Unknown, tangent_hold};
use crate::limits::LIMITS;
use crate::scene::corner::{Corner, Passing};
use crate::scene::world::World;
use rod_core::{Hold, Section};
use smallvec::SmallVec;
use std::f64::consts::TAU;

/// Length (L) plus turn (rad) of a piece or corner that a contact passes within the rounding of a pose.
const SLIVER: f64 = 1e-9;

/// The configuration without contact j.
pub(crate) fn without_contact(mut configuration: Configuration, j: usize) -> Configuration {
    configuration.remove(j);
    configuration
}

/// Contact j moved over the border of its stretch to where `next` begins. The angle of a closed contour jumps by whole
/// turns where it begins anew.
pub(crate) fn onto_neighbour(
    mut configuration: Configuration,
    j: usize,
    upwards: bool,
    next: usize,
    world: &World<'_>,
) -> Configuration {
    let here = configuration.contacts[j].stretch;
    let (leaves, enters) = (world.border(here, upwards), world.border(next, !upwards));
    if let Hold::Tangent { offset } = &mut configuration.contacts[j].hold {
        let jump = world.support(here, leaves).alpha - world.support(next, enters).alpha;
        *offset += TAU * (jump / TAU).round();
    }
    configuration.contacts[j].stretch = next;
    configuration.set(Unknown::Parameter(j), enters);
    configuration
}

/// For each contact at a border of its stretch: the contact set with this contact on the next stretch.
pub(crate) fn beyond_borders(configuration: &Configuration, world: &World<'_>) -> SmallVec<[Configuration; 2]> {
    let mut passed = SmallVec::new();
    for (j, held) in configuration.contacts.iter().enumerate() {
        for upwards in [false, true] {
            let is_there = (configuration.t(j) - world.border(held.stretch, upwards)).abs() < SLIVER;
            let next = world.neighbour(held.stretch, upwards).filter(|next| is_there && !world.is_notch(*next));
            passed.extend(next.map(|next| onto_neighbour(configuration.clone(), j, upwards, next, world)));
        }
    }
    passed
}

/// The contact set beyond a stretch shorter than [`SLIVER`]: the contact that has come onto it is moved to its other end. None where no contact
/// has come onto such a stretch, or where the contour ends.
pub(crate) fn over_sliver(before: &Configuration, after: &Configuration, world: &World<'_>) -> Option<Configuration> {
    let passes = |j: &usize| before.contacts[*j].stretch != after.contacts[*j].stretch;
    let j = (0..before.count().min(after.count())).find(passes)?;
    let sliver = after.contacts[j].stretch;
    let upwards = world.neighbour(before.contacts[j].stretch, true) == Some(sliver);
    let [from, to] = [false, true].map(|upper| world.support(sliver, world.border(sliver, upper)));
    let length = (to.x - from.x).hypot(to.y - from.y) + (to.alpha - from.alpha).abs();
    let beyond = world.neighbour(sliver, upwards).filter(|_| length < SLIVER)?;
    Some(onto_neighbour(after.clone(), j, upwards, beyond, world))
}

/// The tip, at an end of its piece where there is a convex corner, on the piece beyond that: on the corner itself it cannot
/// rest.
pub(crate) fn beyond_corner(mut configuration: Configuration, world: &World<'_>) -> Option<Configuration> {
    let last = configuration.count().checked_sub(1).filter(|last| configuration.is_tip(*last))?;
    let (corner, upwards) = corner_ahead(&configuration, last, world)?;
    let beyond = world.neighbour(corner, upwards)?;
    configuration.contacts[last].stretch = beyond;
    configuration.set(Unknown::Parameter(last), world.border(beyond, !upwards));
    Some(configuration)
}

/// The tip, at an end of its piece where there is a convex corner, beyond that corner, which the rod then lies on. None where the
/// rod could not lie on the corner in its direction.
pub(crate) fn across_corner(mut configuration: Configuration, world: &World<'_>) -> Option<Configuration> {
    let last = configuration.count().checked_sub(1).filter(|last| configuration.is_tip(*last))?;
    let corner = corner_ahead(&configuration, last, world)?.0;
    let phi = configuration.slope(last);
    let Passing { alpha, t, .. } = Corner::new(world, corner).passing(&Section { x: 0.0, y: 0.0, phi, kappa: 0.0 })?;
    configuration.contacts[last] = ActiveContact::smooth(corner, tangent_hold(phi - alpha));
    configuration.set(Unknown::Parameter(last), t);
    configuration.set(Unknown::ArcLength(last), 1.0);
    Some(configuration)
}

/// The convex corner at the end of the piece that contact j is next to, and on which side of the piece it is.
fn corner_ahead(configuration: &Configuration, j: usize, world: &World<'_>) -> Option<(usize, bool)> {
    let (here, t) = (configuration.contacts[j].stretch, configuration.t(j));
    let range = world.range(here);
    let upwards = t - range.from > range.to - t;
    let corner = world.neighbour(here, upwards).filter(|next| world.is_corner(*next))?;
    Some((corner, upwards))
}

/// The last contact, new on a corner and at s = 1, as a contact of the tip on each of the two pieces that end there.
pub(crate) fn beside_corner(configuration: &Configuration, world: &World<'_>) -> SmallVec<[Configuration; 2]> {
    let last = configuration.count().checked_sub(1);
    let is_new = last.is_some_and(|last| configuration.force(last).abs() < FORCE_TOLERANCE);
    if is_new { off_corner(configuration, world) } else { SmallVec::new() }
}

/// The last contact, on a corner and at s = 1, as a contact of the tip on each of the two pieces that end there.
pub(crate) fn off_corner(configuration: &Configuration, world: &World<'_>) -> SmallVec<[Configuration; 2]> {
    let at_tip = |j: usize| !configuration.is_tip(j) && (configuration.s(j) - 1.0).abs() < LIMITS.transition.at_tip;
    let on_corner = |j: usize| world.is_corner(configuration.contacts[j].stretch);
    let last = configuration.count().checked_sub(1).filter(|j| at_tip(*j) && on_corner(*j));
    let Some(last) = last else { return SmallVec::new() };
    let corner = configuration.contacts[last].stretch;
    let pieces = [false, true].into_iter().filter_map(|after| Some((world.neighbour(corner, after)?, after)));
    let on_piece = |(piece, after): (usize, bool)| {
        let mut beside = as_tip(configuration.clone(), world);
        beside.contacts[last].stretch = piece;
        beside.set(Unknown::Parameter(last), world.border(piece, !after));
        beside
    };
    pieces.map(on_piece).collect()
}

/// The last contact, tangential at s = 1, as a contact of the tip.
pub(crate) fn as_tip(mut configuration: Configuration, world: &World<'_>) -> Configuration {
    let last = configuration.count() - 1;
    let ActiveContact { stretch, hold, .. } = configuration.contacts[last];
    if let Hold::Tangent { offset } = hold {
        let lying = world.support(stretch, configuration.t(last)).alpha + offset;
        configuration.set(Unknown::Slope(last), lying);
        configuration.contacts[last].hold = Hold::Tip;
    }
    configuration
}

/// The contact at the tip, where phi(1) - alpha is about `angle`, as a tangential one at s = 1.
pub(crate) fn as_tangent(mut configuration: Configuration, angle: f64) -> Configuration {
    let last = configuration.count() - 1;
    configuration.contacts[last].hold = tangent_hold(angle);
    configuration.set(Unknown::ArcLength(last), 1.0);
    configuration
}
