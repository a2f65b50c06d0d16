//! The last contact at an inflection of the contour, where one contact splits into two or two merge.
//!
//! Behind its last contact the rod is straight, so that the contour is convex there. Where the contact comes to an
//! inflection, with the concave part on the clamp's side, it cannot go on. The contour is y = c x^3 + d x^4 there, and
//! so is the rod to the leading order. Two contacts a small distance l apart hold it there: the one nearer to the
//! tip has the force 6 c (the rate of the contour's curvature) and a distance of order l^2 from the inflection.
//! This requires d < 0 if the solid is at y < 0 and c > 0; otherwise the rod snaps. The rod is assumed to be straight at rest.

use crate::contact_set::{ActiveContact, Configuration, Unknown};
use crate::continuation::branch::Corrector;
use crate::continuation::transition::{Transition, solve_fixed};
use crate::event::EventKind;
use crate::limits::LIMITS;
use crate::scene::world::World;
use rod_contours::StretchKind;
use rod_core::{Hold, PhysicalRod, RodModel, find_root};

/// An inflection: its parameter, the rate of the contour's curvature along the rod's length, and the change of the
/// parameter along it.
struct Inflection {
    t: f64,
    rate: f64,
    by_s: f64,
}

/// The inflection next to contact j, with the concave side towards the clamp.
fn inflection(world: &World<'_>, configuration: &Configuration, j: usize) -> Option<Inflection> {
    let ActiveContact { stretch, hold: Hold::Tangent { offset }, .. } = configuration.contacts[j] else { return None };
    if !matches!(world.kind(stretch), StretchKind::Piece(_)) {
        return None;
    }
    let t = configuration.t(j);
    let by_s = offset.cos() / world.support(stretch, t).speed;
    let curvature = |t: f64| {
        let support = world.support(stretch, t);
        support.turning / support.speed
    };
    let range = world.span(stretch);
    let (before, after) = (range.clamp(t - LIMITS.merge.search * by_s), range.clamp(t + LIMITS.merge.search * by_s));
    if !(curvature(before) < 0.0 && curvature(after) > 0.0) {
        return None;
    }
    let t = find_root("curvature", |t| Ok(curvature(t)), before.min(after), before.max(after), 0.0).ok()?.at;
    let (before, after) =
        (range.clamp(t - LIMITS.merge.at_inflection * by_s), range.clamp(t + LIMITS.merge.at_inflection * by_s));
    let rate = (curvature(after) - curvature(before)) / ((after - before) / by_s);
    Some(Inflection { t, rate, by_s })
}

/// Whether the last contact is at an inflection. A rod that has no other equilibrium there lies along the contour, because an elastica
/// follows a cubic spline to the leading order.
pub(crate) fn is_at_inflection(world: &World<'_>, configuration: &Configuration) -> bool {
    let last = configuration.count().checked_sub(1);
    last.is_some_and(|j| {
        inflection(world, configuration, j).is_some_and(|Inflection { t, by_s, .. }| {
            (configuration.t(j) - t).abs() < LIMITS.merge.beside_inflection * by_s.abs()
        })
    })
}

/// The transition at which the last contact, which has come to an inflection at `from` or just beyond, splits into two: before it one contact at
/// the inflection, after it two contacts at the smallest distance at which their equations are solved.
pub(crate) fn split_at_inflection<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
) -> Option<Transition> {
    let j = from.count().checked_sub(1).filter(|_| corrector.setup.rod.model().is_straight())?;
    let Inflection { t, rate, by_s } = inflection(&corrector.setup.world, from, j)?;
    let before = solve_fixed(corrector, from.clone(), Unknown::Parameter(j), t).ok()?;
    let (s, f) = (before.s(j), before.force(j));
    let after = LIMITS.merge.multiples.into_iter().find_map(|farther| {
        let l = farther * LIMITS.merge.at_inflection;
        let first = t - l * by_s;
        let mut two = before.clone();
        two.set(Unknown::Force(j), rate);
        two.insert(j, two.contacts[j], [first, f - rate, s - l]);
        let two = solve_fixed(corrector, two, Unknown::Parameter(j), first).ok()?;
        let way = two.tau() - before.tau();
        let holds = (0..two.count()).all(|k| two.force(k) > 0.0) && two.is_ordered(&corrector.setup.world);
        ((0.0..LIMITS.merge.longest_way).contains(&way) && holds).then_some(two)
    })?;
    Some(Transition { kind: EventKind::Touch, before, after, along: 0.0 })
}

/// The transition at which the last two contacts, close to an inflection between them, merge into one.
pub(crate) fn merge_at_inflection<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
) -> Option<Transition> {
    let j = from.count().checked_sub(2).filter(|_| corrector.setup.rod.model().is_straight())?;
    let [one, other] = from.contacts.last_chunk::<2>()?;
    if one != other || from.s(j + 1) - from.s(j) > LIMITS.merge.at_inflection {
        return None;
    }
    let Inflection { t, by_s, .. } = inflection(&corrector.setup.world, from, j + 1)?;
    let mut together = from.clone();
    together.remove(j);
    together.set(Unknown::Force(j), from.force(j + 1) + from.force(j));
    let after =
        solve_fixed(corrector, together, Unknown::Parameter(j), t + LIMITS.merge.beside_inflection * by_s).ok()?;
    let way = after.tau() - from.tau();
    (0.0..LIMITS.merge.longest_way).contains(&way).then(|| Transition {
        kind: EventKind::Release,
        before: from.clone(),
        after,
        along: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{Bezier, Composite};

    /// An S, symmetric about the origin, where it has its inflection; `flip` is its mirror image.
    fn s_bend(flip: f64) -> Composite {
        let points = [[-1.0, -0.1], [-0.4, 0.3], [0.4, -0.3], [1.0, 0.1]].map(|[x, y]| [x, flip * y]);
        Composite::single(Bezier::new(points).unwrap()).unwrap()
    }

    fn lying_at(t: f64) -> Configuration {
        let mut lying = Configuration::free(0.0);
        lying.insert(0, ActiveContact::smooth(0, Hold::Tangent { offset: 0.0 }), [t, 1.0, 0.7]);
        lying
    }

    #[test]
    fn an_inflection_is_found_from_near_by_where_the_hollow_is_on_the_clamps_side() {
        let (one, other) = (s_bend(1.0), s_bend(-1.0));
        let worlds = [&one, &other].map(|contour| World::new(contour.as_ref(), 1.0));
        let found = worlds.each_ref().map(|world| {
            let range = world.range(0);
            let middle = 0.5 * (range.from + range.to);
            let near = lying_at(middle + 0.005);
            inflection(world, &near, 0).map(|found| (found, middle, is_at_inflection(world, &lying_at(middle))))
        });
        let [Some((Inflection { t, rate, .. }, middle, at)), None] = found else { panic!("one of the two") };
        assert!((t - middle).abs() < 1e-12 && rate > 0.0 && at);
        assert!(!is_at_inflection(&worlds[0], &lying_at(middle + 0.01)));
    }

    #[test]
    fn none_is_found_far_away() {
        let contour = s_bend(1.0);
        let world = World::new(contour.as_ref(), 1.0);
        let range = world.range(0);
        assert!(inflection(&world, &lying_at(range.from + 0.2 * (range.to - range.from)), 0).is_none());
    }
}
