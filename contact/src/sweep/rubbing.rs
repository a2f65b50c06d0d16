//! A sweep with friction: the modes of the contacts are chosen anew at every event.

use super::Sweep;
use super::landing::{EndedBranch, without_friction};
use crate::contact_set::{Configuration, Segments};
use crate::continuation::branch::Corrector;
use crate::continuation::certify::energy;
use crate::continuation::{Point, Seen, Step};
use crate::error::StopReason;
use crate::event::EventKind;
use crate::friction::sliding::{sliding_near, with_ratios};
use crate::friction::{Motion, UNLOADED, friction_work, possible_motions};
use crate::limits::LIMITS;
use crate::scene::rod::along;
use rod_core::{Grip, PhysicalRod};

/// The contact that has come to rest, if the event is of kind `Stick`.
pub(super) fn contact_at_rest(kind: EventKind, before: &Configuration, after: &Configuration) -> Option<usize> {
    if kind == EventKind::Stick { (0..after.count()).find(|&j| comes_to_rest(before, after, j)) } else { None }
}

/// Whether contact j slips before and sticks after.
fn comes_to_rest(before: &Configuration, after: &Configuration, j: usize) -> bool {
    after.contacts[j].grip.sticks() && !before.contacts[j].grip.sticks()
}

/// Number of contacts under a force that go on in another mode.
fn count_changed_modes(before: &Configuration, after: &Configuration) -> usize {
    let changes = |j: &usize| match (before.contacts[*j].grip, after.contacts[*j].grip) {
        (Grip::Sticks { .. }, Grip::Sticks { .. }) => false,
        (Grip::Slips { ratio }, Grip::Slips { ratio: then }) => ratio * then <= 0.0,
        _ => true,
    };
    (0..after.count()).filter(|j| before.force(*j) >= UNLOADED).filter(changes).count()
}

/// The event where the path turns, if the mode of a contact changes there.
fn event_of_turn(before: &Configuration, after: &Configuration) -> Option<EventKind> {
    let slips = |j: usize| !after.contacts[j].grip.sticks();
    let turns = |j: usize| before.contacts[j].grip.sticks() || after.friction(j) * before.friction(j) < 0.0;
    if (0..after.count()).any(|j| comes_to_rest(before, after, j)) {
        return Some(EventKind::Stick);
    }
    (0..after.count()).any(|j| slips(j) && turns(j)).then_some(EventKind::Slip)
}

/// The equilibrium with friction near `landed`, to which a descent without friction has led. Statics does not determine this friction, because it
/// depends on the motion: at each contact it opposes the motion from the shape `before`. None where there is no such equilibrium.
fn with_drag<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    landed: &Configuration,
    before: &Segments,
) -> Option<Configuration> {
    let world = &corrector.setup.world;
    let ratio = |j: usize| {
        let held = landed.contacts[j];
        if world.is_notch(held.stretch) {
            return 0.0;
        }
        let at = world.support(held.stretch, landed.t(j));
        let was = along(corrector.setup.rod.model(), before, landed.s(j));
        let way = (at.x - was.x) * at.alpha.cos() + (at.y - was.y) * at.alpha.sin();
        -world.coefficients(held.stretch).slipping * way.signum()
    };
    let ratios: Vec<f64> = (0..landed.count()).map(ratio).collect();
    with_ratios(corrector, landed, &ratios)
}

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The point from which the sweep goes on with the contacts of `seen`, in modes whose motion along the path is admissible. None where no
    /// motion is: then the rod snaps. `stopped` is a contact that has just come to rest.
    pub(super) fn continue_rubbing(&mut self, seen: Seen, stopped: Option<usize>) -> Result<Option<Point>, StopReason> {
        if seen.configuration.count() == 0 {
            return Ok(self.continue_with(seen));
        }
        let ways = match possible_motions(self.setup(), &seen.configuration, stopped) {
            Motion::Ways(ways) => ways,
            Motion::Jams => return Err(StopReason::Jammed),
            Motion::TooMany => return Err(StopReason::Undetermined),
        };
        // what slips goes on to slip where it can, although friction at rest could hold it; then a contact goes on as it did
        let rank = |way: &Configuration| {
            (self.count_held_at_rest(&seen.configuration, way), count_changed_modes(&seen.configuration, way))
        };
        let mut ways: Vec<_> = ways.into_iter().map(|way| (rank(&way), way)).collect();
        ways.sort_by_key(|(rank, _)| *rank);
        // the least rank, and of two such motions the one that holds for longer; none of two that hold as long
        let mut found: Option<((usize, usize), usize, Option<Point>)> = None;
        for (rank, mut way) in ways {
            if found.as_ref().is_some_and(|(least, ..)| rank > *least) {
                break;
            }
            // a coefficient that has changed at once moves the rod
            let moved = (0..way.count()).any(|j| {
                (way.friction(j) - seen.configuration.friction(j)).abs()
                    > LIMITS.sweep.friction_change * (1.0 + way.force(j))
            });
            let tau = way.tau();
            if moved {
                let is_solved = self.stepper.corrector.at_pose(&mut way, tau).status.is_solved();
                // the energy rises where another contact would have gone against its mode
                if !is_solved || !self.may_fall(energy(self.setup(), &seen.configuration), &way) {
                    continue;
                }
            }
            let point = self.point_of(way);
            let Some(probe) = self.stepper.longest_rubbing_probe(&point) else { continue };
            match &mut found {
                Some((_, longest, both)) if probe == *longest => *both = None,
                Some((_, longest, _)) if probe > *longest => {}
                _ => found = Some((rank, probe, Some(point))),
            }
        }
        match found {
            Some((.., None)) => Err(StopReason::Undetermined),
            found => Ok(found.and_then(|(.., point)| point)),
        }
    }

    /// Whether a tangential contact stays on the border of two pieces with different friction: on the rougher piece it would roll back, on the
    /// smoother one slip forward. Its force along the contour is then between the limits of the two pieces.
    pub(super) fn is_held_at_border(&mut self, before: &Configuration, after: &Configuration) -> bool {
        let world = &self.setup().world;
        let roughness = |here: &Configuration, j: usize| world.coefficients(here.contacts[j].stretch);
        let passes = |j: &usize| !before.is_tip(*j) && roughness(before, *j) != roughness(after, *j);
        let Some(j) = (0..before.count().min(after.count())).find(passes) else { return false };
        let (from, onto) = (roughness(before, j), roughness(after, j));
        if onto.at_rest >= from.at_rest {
            return true;
        }
        // with the force that the smoother piece can bear it is back on the rougher one, or jumps away
        let (range, mut slipping) = (world.range(after.contacts[j].stretch), after.clone());
        slipping.set_slipping(j, onto.slipping.copysign(after.friction(j)));
        let is_solved = self.stepper.corrector.at_pose(&mut slipping, after.tau()).status.is_solved();
        is_solved && range.clamp(slipping.t(j)) != slipping.t(j)
    }

    /// Number of contacts that come to rest where the static coefficient is larger than the kinetic one.
    fn count_held_at_rest(&self, before: &Configuration, after: &Configuration) -> usize {
        let holds_more = |j: usize| {
            let coefficients = self.setup().world.coefficients(after.contacts[j].stretch);
            coefficients.at_rest > coefficients.slipping
        };
        (0..after.count()).filter(|&j| comes_to_rest(before, after, j) && holds_more(j)).count()
    }

    /// Where a step leads from a point, with the work of friction on the way.
    pub(super) fn follow(&mut self, from: &Point, step: Step) -> Result<Box<Point>, StopReason> {
        if self.setup().world.rubs() {
            let work = friction_work(&mut self.stepper.corrector, (&from.configuration, &from.tangent), step.last());
            self.dissipated = self.dissipated.zip(work).map(|(before, more)| before + more);
        }
        self.arrive(step)
    }

    /// The point to begin with where a path turns, or where an equilibrium was given.
    pub(super) fn resume_rubbing(&mut self, given: Configuration) -> Result<(Point, Option<Step>), StopReason> {
        let seen = self.stepper.look(given);
        if let Some(point) = self.continue_rubbing(seen.clone(), None)? {
            let turned = event_of_turn(&seen.configuration, &point.configuration);
            // the first state of all has the modes in which it goes on
            if let Some(kind) = turned.filter(|_| !self.course.is_new()) {
                let before = self.stepper.point(seen);
                self.announce(kind, &before, &point);
            }
            return Ok((point, None));
        }
        let point = self.stepper.point(seen);
        let ends = point.end();
        Ok((point, Some(ends)))
    }

    /// The point from which the sweep goes on where the rod has landed, with no more energy than `last` has. Friction opposes the motion of each contact
    /// from `last`. Where there is no such equilibrium, or where it is `last` itself, all contacts stick without a force along the contour.
    pub(super) fn continue_from_landing(&mut self, landed: Seen, last: &EndedBranch) -> Option<Point> {
        if !self.may_fall(last.energy, &landed.configuration) {
            return None;
        }
        if self.setup().world.sliding() != 0.0 {
            let slides = sliding_near(&mut self.stepper.corrector, &landed.configuration)?;
            let seen = self.stepper.look(slides);
            return self.continue_with(seen);
        }
        if !self.setup().world.rubs() || landed.configuration.count() == 0 {
            return self.continue_with(landed);
        }
        let before = last.seen.configuration.segments(self.setup());
        let dragged = with_drag(&mut self.stepper.corrector, &landed.configuration, &before);
        let elsewhere =
            dragged.filter(|dragged| !dragged.is_same_equilibrium(&last.seen.configuration, &self.setup().world));
        for way in elsewhere.into_iter().chain([without_friction(&landed.configuration)]) {
            let seen = self.stepper.look(way);
            let point = self.continue_rubbing(seen, None).ok().flatten();
            if let Some(point) = self.if_energy_falls(last.energy, point) {
                return Some(point);
            }
        }
        None
    }
}
