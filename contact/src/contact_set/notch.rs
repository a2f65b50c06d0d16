//! The tip in a notch: two walls hold it, given as one force whose direction is free between their normals.
//!
//! The tip enters and leaves a notch over the end of a wall, where the contour's parameter runs on. It also enters and leaves sideways: where
//! the rod lies down on one wall at the tip, the force splits into a tangential contact on that wall, which then moves up the rod, and a tip
//! contact on the other wall.

use crate::contact_set::{ActiveContact, Configuration, Unknown, tangent_hold};
use crate::scene::world::World;
use rod_core::Hold;
use std::f64::consts::{PI, TAU};

/// The parameter and the tangent angle of a wall at its end in `notch`.
fn edge(world: &World<'_>, notch: usize, wall: usize) -> (f64, f64) {
    let t = world.border(wall, world.neighbour(notch, false) == Some(wall));
    (t, world.support(wall, t).alpha)
}

/// The wall of its notch that the rod, resting there with the tip, goes through, and phi(1) minus the wall's angle.
pub(crate) fn wall_run_into(world: &World<'_>, configuration: &Configuration, tolerance: f64) -> Option<(usize, f64)> {
    let last = configuration.count().checked_sub(1)?;
    let notch = configuration.contacts[last].stretch;
    if !configuration.is_tip(last) || !world.is_notch(notch) {
        return None;
    }
    let phi = configuration.slope(last);
    world
        .walls(notch)
        .into_iter()
        .flatten()
        .map(|wall| (wall, phi - edge(world, notch, wall).1))
        .find(|(_, angle)| angle.sin() < -tolerance)
}

/// The slope angle at the tip with which the rod lies on `wall`, `angle` being about its distance to the wall's.
pub(crate) fn lying_angle(world: &World<'_>, configuration: &Configuration, wall: usize, angle: f64) -> f64 {
    let notch = configuration.contacts[configuration.count() - 1].stretch;
    edge(world, notch, wall).1 + PI * (angle / PI).round()
}

/// The tip in a notch, lying on `wall`, as two contacts: tangential on `wall`, still at s = 1, and the tip on the other
/// wall.
pub(crate) fn split_onto_walls(world: &World<'_>, configuration: &Configuration, wall: usize) -> Configuration {
    let mut parted = configuration.clone();
    let last = configuration.count() - 1;
    let notch = configuration.contacts[last].stretch;
    let Some(other) = world.walls(notch).into_iter().flatten().find(|other| *other != wall) else { return parted };
    let ((t, alpha_wall), (t_other, alpha_other)) = (edge(world, notch, wall), edge(world, notch, other));
    let (f, alpha) = (configuration.force(last), world.support(notch, configuration.t(last)).alpha);
    let whole = (alpha_other - alpha_wall).sin();
    let hold = tangent_hold(configuration.slope(last) - alpha_wall);
    parted.contacts[last].stretch = other;
    parted.set(Unknown::Parameter(last), t_other);
    parted.set(Unknown::Force(last), f * (alpha - alpha_wall).sin() / whole);
    let force = f * (alpha_other - alpha).sin() / whole;
    parted.insert(last, ActiveContact::smooth(wall, hold), [t, force, 1.0]);
    parted
}

/// The force of contact j, with its friction, carried over the border between a wall and its notch, from `before` to `after`. In the notch both
/// walls hold the rod, each with a force within its cone of friction: only their sum is known, whose direction is the parameter.
pub(crate) fn with_cone(
    world: &World<'_>,
    before: &Configuration,
    mut after: Configuration,
    j: usize,
    upwards: bool,
) -> Configuration {
    let [from, to] = [before, &after].map(|configuration| configuration.contacts[j].stretch);
    let turning = |notch: usize| world.support(notch, world.border(notch, false)).turning;
    if world.is_notch(to) {
        let (force, friction) = (before.force(j), before.friction(j));
        after.set_slipping(j, 0.0);
        let t = after.t(j) + friction.atan2(force) / turning(to);
        after.set(Unknown::Parameter(j), t);
        after.set(Unknown::Force(j), force.hypot(friction));
    } else if world.is_notch(from) {
        let angle = (before.t(j) - world.border(from, upwards)) * turning(from);
        after.set(Unknown::Force(j), before.force(j) * angle.cos());
        after.set_slipping(j, angle.tan());
    }
    after
}

/// Adds to the tip contact, which is on one wall of a notch, a force of `stretch`, the other wall: the tip rests in the
/// notch. Nothing where the two do not meet in a notch.
pub(crate) fn into_notch(world: &World<'_>, configuration: &mut Configuration, stretch: usize, alpha: f64, force: f64) {
    let last = configuration.count() - 1;
    let (held, f) = (configuration.contacts[last].stretch, configuration.force(last));
    let Some(notch) = world.notch_between(held, stretch) else { return };
    let normal = world.support(held, configuration.t(last)).alpha;
    rest_in(world, configuration, notch, (alpha, force), (normal, f));
}

/// The tip rests in `notch`, which gives the sum of two forces: for each, the tangent angle to which it is normal, and its size.
fn rest_in(world: &World<'_>, configuration: &mut Configuration, notch: usize, one: (f64, f64), other: (f64, f64)) {
    let last = configuration.count() - 1;
    let [a, b] = [f64::cos, f64::sin].map(|part| one.1 * part(one.0) + other.1 * part(other.0));
    let range = world.range(notch);
    // along a notch alpha falls by 1 per unit of its parameter
    let turned = world.support(notch, range.from).alpha - b.atan2(a);
    let t = range.from + turned - TAU * (turned / TAU).round();
    configuration.contacts[last].stretch = notch;
    configuration.set(Unknown::Parameter(last), t.clamp(range.from, range.to));
    configuration.set(Unknown::Force(last), a.hypot(b));
}

/// A tip in a notch and a contact on one of its walls replaced by the tip in the notch alone, with the sum of their forces; and the slope angle
/// at the tip with which the rod lies on that wall.
pub(crate) fn tip_alone_in_notch(world: &World<'_>, configuration: &Configuration) -> (Configuration, f64) {
    let mut gathered = configuration.clone();
    let (lying, tip) = (configuration.count() - 2, configuration.count() - 1);
    let (wall, force) = (configuration.contacts[lying].stretch, configuration.force(lying));
    let alpha = world.support(wall, configuration.t(lying)).alpha;
    let offset = if let Hold::Tangent { offset } = configuration.contacts[lying].hold { offset } else { 0.0 };
    let (held, f) = (configuration.contacts[tip].stretch, configuration.force(tip));
    let normal = world.support(held, configuration.t(tip)).alpha;
    gathered.remove(lying);
    rest_in(world, &mut gathered, held, (alpha, force), (normal, f));
    (gathered, alpha + offset)
}

/// The same rod with its tip on the other wall, if it lies on one wall up to its tip in the notch. Where the force in the notch vanishes, its
/// direction is undefined, but the equations of the two contacts on the walls are regular.
pub(crate) fn split_at_notch(world: &World<'_>, configuration: &Configuration) -> Option<Configuration> {
    let [lying, tip] = configuration.contacts.last_chunk::<2>()?;
    let walls = Some(tip.stretch)
        .filter(|notch| tip.hold == Hold::Tip && world.is_notch(*notch))
        .map(|notch| world.walls(notch))?;
    let other = match walls {
        [Some(wall), other] | [other, Some(wall)] if wall == lying.stretch => other?,
        _ => return None,
    };
    let mut on_wall = configuration.clone();
    let last = configuration.count() - 1;
    on_wall.set(Unknown::Parameter(last), edge(world, tip.stretch, other).0);
    on_wall.contacts[last].stretch = other;
    Some(on_wall)
}

/// Whether the last two contacts are the two walls of one notch, the tip on one and the rod lying on the other.
pub(crate) fn straddles(world: &World<'_>, configuration: &Configuration) -> bool {
    let Some([lying, tip]) = configuration.contacts.last_chunk::<2>() else { return false };
    tip.hold == Hold::Tip && world.notch_between(lying.stretch, tip.stretch).is_some()
}

/// Two contacts that have met in the notch between their walls, replaced by the one contact in the notch.
pub(crate) fn merge_in_notch(world: &World<'_>, configuration: &Configuration) -> Configuration {
    let mut merged = configuration.clone();
    let lying = configuration.count() - 2;
    let (stretch, force) = (configuration.contacts[lying].stretch, configuration.force(lying));
    let alpha = world.support(stretch, configuration.t(lying)).alpha;
    merged.remove(lying);
    into_notch(world, &mut merged, stretch, alpha, force);
    merged
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{Composite, StretchKind};

    /// A right-angled notch at the origin, open downwards: the solid is above.
    fn notch() -> Composite {
        Composite::polyline(&[[-1.0, -1.0], [0.0, 0.0], [1.0, -1.0]]).unwrap()
    }

    fn rests(world: &World<'_>, phi: f64) -> (Configuration, usize) {
        let notch = world.find(0, StretchKind::Notch { before: 0 }).unwrap();
        let mut resting = Configuration::free(0.0);
        let t = 0.5 * (world.range(notch).from + world.range(notch).to);
        resting.insert(0, ActiveContact::smooth(notch, Hold::Tip), [t, 2.0, phi]);
        (resting, notch)
    }

    #[test]
    fn a_rod_lies_down_on_the_wall_that_it_leans_to() {
        let contour = notch();
        let world = World::new(contour.as_ref(), 1.0);
        let upright = rests(&world, 0.5 * PI).0;
        assert_eq!(wall_run_into(&world, &upright, 1e-13), None);
        let [before, after] = world.walls(rests(&world, 0.0).1).map(Option::unwrap);
        for (phi, wall) in [(0.24 * PI, before), (0.76 * PI, after)] {
            let (leaning, _) = rests(&world, phi);
            let (found, angle) = wall_run_into(&world, &leaning, 1e-13).unwrap();
            assert_eq!(found, wall, "{phi}");
            let lying = lying_angle(&world, &leaning, found, angle);
            assert!((lying - phi).abs() < 0.02 * PI, "{lying}");
        }
    }

    #[test]
    fn the_force_in_a_notch_parts_and_merges_again() {
        let contour = notch();
        let world = World::new(contour.as_ref(), 1.0);
        let (resting, notch) = rests(&world, 0.25 * PI);
        let [wall, _] = world.walls(notch).map(Option::unwrap);
        let two = split_onto_walls(&world, &resting, wall);
        assert!(two.count() == 2 && straddles(&world, &two) && two.ends_at_tip());
        let root_2 = 2.0_f64.sqrt();
        assert!((two.force(0) - root_2).abs() < 1e-14 && (two.force(1) - root_2).abs() < 1e-14);
        let one = merge_in_notch(&world, &two);
        assert!(one.count() == 1 && one.contacts[0].stretch == notch);
        assert!((one.force(0) - 2.0).abs() < 1e-14 && (one.t(0) - resting.t(0)).abs() < 1e-14);
    }
}
