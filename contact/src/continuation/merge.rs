//! Merge two contacts that are about to become one, before their equations become singular.

use crate::contact_set::notch::{split_onto_walls, tip_alone_in_notch};
use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::{Corrector, Tangent};
use crate::continuation::inflection::merge_at_inflection;
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::{Transition, breaks, solve_fixed};
use crate::event::EventKind;
use crate::limits::LIMITS;
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Stepper<'_, R> {
    /// The transition at which two contacts become one, if two are about to.
    pub(super) fn merge_contacts(&mut self, next: &Configuration, tangent: &Tangent) -> Option<Transition> {
        self.merge_last(next, tangent).or_else(|| self.merge_on_piece(next, tangent))
    }

    /// The last two contacts as one, if they are about to meet in a notch or at an inflection.
    fn merge_last(&mut self, next: &Configuration, tangent: &Tangent) -> Option<Transition> {
        let j = next.count().checked_sub(2)?;
        if next.ends_at_tip() {
            return (tangent.rate_of(Unknown::ArcLength(j)) > 0.0)
                .then(|| merge_at_notch(&mut self.corrector, next))
                .flatten();
        }
        let closes = tangent.rate_of(Unknown::ArcLength(j + 1)) < tangent.rate_of(Unknown::ArcLength(j));
        closes.then(|| merge_at_inflection(&mut self.corrector, next)).flatten()
    }

    /// Two contacts on one convex piece that approach each other, as one: where they are so close that the rod lies on the one alone as soon as
    /// the clamp has gone a little further. The force of the other vanishes on that way.
    fn merge_on_piece(&mut self, next: &Configuration, tangent: &Tangent) -> Option<Transition> {
        let j = (1..next.count()).find(|&j| {
            let [before, rate] = [j - 1, j].map(|j| tangent.rate_of(Unknown::ArcLength(j)));
            let same = next.contacts[j - 1] == next.contacts[j] && !next.is_tip(j);
            same && next.s(j) - next.s(j - 1) < LIMITS.merge.close && rate < before
        })?;
        let (weak, strong) = if next.force(j) < next.force(j - 1) { (j, j - 1) } else { (j - 1, j) };
        let mut one = next.clone();
        one.set(Unknown::Force(strong), next.force(j) + next.force(j - 1));
        one.remove(weak);
        LIMITS.merge.ways.into_iter().find_map(|way| {
            let after = solve_fixed(&mut self.corrector, one.clone(), Unknown::Path, next.tau() + way).ok()?;
            // proven as a state is, since the next one must be
            let scan = self.scan(&after);
            let mut holds = scan.is_outside() && self.is_stable(&after, &scan);
            breaks(&self.corrector.setup.world, &after, &scan.crossings, |_| holds = false);
            holds.then(|| Transition { kind: EventKind::Release, before: next.clone(), after, along: 0.0 })
        })
    }
}

/// The rod lies on a wall with the tip in its notch, held before the notch by a contact that slides there: the transition where
/// that contact arrives, and the rod begins to stand up from the wall. At the transition itself the two contacts are one point, and
/// their equations singular; so it is located on the branch after it, as [`Break::OntoWall`](super::transition::Break) is on the one before.
fn merge_at_notch<R: PhysicalRod>(corrector: &mut Corrector<'_, R>, near: &Configuration) -> Option<Transition> {
    let world = &corrector.setup.world;
    let lying = near.count().checked_sub(2)?;
    let wall = near.contacts[lying].stretch;
    let notch = near.contacts[lying + 1].stretch;
    let rests = world.is_notch(notch) && world.walls(notch).contains(&Some(wall)) && !near.rubs();
    if !rests || 1.0 - near.s(lying) > LIMITS.merge.at_notch {
        return None;
    }
    let (start, angle) = tip_alone_in_notch(world, near);
    let after = solve_fixed(corrector, start, Unknown::Slope(lying), angle).ok()?;
    let before = split_onto_walls(&corrector.setup.world, &after, wall);
    (after.tau() >= near.tau()).then_some(Transition { kind: EventKind::Release, before, after, along: 0.0 })
}
