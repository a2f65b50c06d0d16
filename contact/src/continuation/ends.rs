//! The checks that end a branch, or refuse a step that may have passed over something.

use crate::contact_set::Configuration;
use crate::continuation::Corrected;
use crate::continuation::branch::Tangent;
use crate::continuation::dip::{dips, least_rate};
use crate::continuation::stepper::{Refused, Stepper};
use crate::continuation::{Point, Step};
use crate::error::{Obstacle, StopReason};
use crate::gap::Scan;
use crate::gap::passing::Passing;
use crate::limits::LIMITS;
use rod_core::{Clamp, PhysicalRod};

/// The obstacle of a step whose scan does not fit the transitions that were located.
pub(super) fn obstacle_of(scan: &Scan) -> Obstacle {
    if scan.crossings.is_empty() { Obstacle::NotLocated } else { Obstacle::Touch }
}

/// The branch ends within a step of this length for `reason`: accepted if the step is short, otherwise the step is refused because of
/// `obstacle`, and halved.
pub(super) fn end_if_short(length: f64, reason: StopReason, obstacle: Obstacle) -> Refused {
    if length < LIMITS.end.short_step { Refused::Ended(reason) } else { Refused::TooLong(obstacle) }
}

impl<R: PhysicalRod> Stepper<'_, R> {
    /// Refuses a step within which the branch turns sharply, or within which a condition that holds at both ends is broken.
    pub(super) fn check_course(&self, from: &Point, corrected: &Corrected) -> Result<(), Refused> {
        // behind a joint the branch has a kink: the two ends say nothing about the way between them
        if corrected.kink {
            return Ok(());
        }
        let Corrected { next, tangent, length, .. } = corrected;
        if tangent.cosine(&from.tangent.direction) < LIMITS.step.least_cosine
            || turns_twice(from, next, tangent, *length)
        {
            return Err(Refused::TooLong(Obstacle::Turns));
        }
        let world = &self.corrector.setup.world;
        if dips(world, (&from.configuration, &from.tangent), (next, tangent), *length) {
            return Err(Refused::TooLong(Obstacle::NotLocated));
        }
        Ok(())
    }

    /// Ends the branch, or refuses the step, where the scan at the end of the step shows that the branch ends within it.
    pub(super) fn check_ends(&self, from: &Point, corrected: &Corrected, scan: &Scan) -> Result<(), Refused> {
        let Corrected { next, length, .. } = corrected;
        let end_if_short = |reason| Err(end_if_short(*length, reason, obstacle_of(scan)));
        if is_clamp_inside(next, scan) {
            return end_if_short(StopReason::ClampInside);
        }
        if self.is_before_roller(next, scan, LIMITS.end.at_roller) {
            return end_if_short(StopReason::BeforeRoller);
        }
        if self.is_around_an_end(from, corrected, scan) {
            return Err(Refused::Ended(StopReason::EndOfContour));
        }
        if scan.has_swept_over_an_end(&from.scan) {
            return end_if_short(StopReason::EndOfContour);
        }
        Ok(())
    }

    /// Refuses a step on which the rod has passed over an object, and ends the branch where the clamp has: on the whole step, which was scanned
    /// at its end, or up to the transition that has `ended` it.
    pub(super) fn check_passing(
        &mut self,
        from: &Point,
        Corrected { length, .. }: &Corrected,
        scan: &Scan,
        ended: Option<&Step>,
    ) -> Result<(), Refused> {
        let reached = ended.map_or(scan, Step::scan);
        match self.passing(from, reached, *length) {
            None => Ok(()),
            Some(Passing::Rod) if ended.is_some() => Err(Refused::TooLong(obstacle_of(scan))),
            Some(Passing::Rod) => Err(Refused::TooLong(Obstacle::PassesOver)),
            Some(Passing::Clamp) => Err(end_if_short(*length, StopReason::ClampInside, obstacle_of(scan))),
        }
    }

    /// What of the rod has passed over an object on its way to where it is scanned `now`.
    fn passing(&mut self, from: &Point, now: &Scan, length: f64) -> Option<Passing> {
        let (setup, far) = (&self.corrector.setup, length > LIMITS.end.least_swept);
        far.then(|| self.scanner.passes(setup, &from.configuration, &from.scan, now)).flatten()
    }

    /// The end of a branch along which not even the shortest step is possible: a snap, or a reason to stop. `touches` tells whether the last
    /// steps were refused because the rod went through an object.
    pub(super) fn end_of_shortest_step(
        &self,
        from: &Point,
        obstacle: Obstacle,
        touches: bool,
    ) -> Result<Step, StopReason> {
        // Behind the end of an open contour there is no telling inside from outside.
        if from.scan.is_by_an_end() {
            return Err(StopReason::EndOfContour);
        }
        if self.is_before_roller(&from.configuration, &from.scan, LIMITS.end.near_roller) {
            return Err(StopReason::BeforeRoller);
        }
        // Where rod and contour are both without curvature, a touch has no isolated solution: the descent finds what follows it.
        if touches {
            return Ok(from.end());
        }
        if self.is_between_objects(&from.configuration) {
            return Err(StopReason::BetweenObjects);
        }
        Err(StopReason::StepTooSmall(obstacle))
    }

    /// Whether the rod goes through an object, or has a contact, between its clamp and the roller ahead, or at most `beyond` that.
    fn is_before_roller(&self, next: &Configuration, scan: &Scan, beyond: f64) -> bool {
        let setup = &self.corrector.setup;
        setup.clamp(next.tau()).roller().is_some_and(|roller| {
            let supports = next.supports(&setup.world);
            let hold = setup.problem(&supports, next.tau()).roller(next.of_contacts());
            let s = hold.map_or(roller.at, |hold| hold.s) + beyond;
            scan.crossings.iter().any(|crossing| crossing.s < s) || (next.count() > 0 && next.s(0) < s)
        })
    }

    /// Whether a free rod is inside an object although no point of it has gone further than the smallest gap was: it came around an end
    /// of an open contour.
    fn is_around_an_end(&self, from: &Point, Corrected { next, length, .. }: &Corrected, scan: &Scan) -> bool {
        let is_open = !self.corrector.setup.world.open_ends().is_empty();
        let is_free = next.count() == 0 && length * self.largest_speed() <= from.scan.gap.lower;
        is_open && is_free && scan.gap.seen < -LIMITS.end.deepest_free
    }

    /// Whether the tip lies on more than one object.
    fn is_between_objects(&self, from: &Configuration) -> bool {
        let world = &self.corrector.setup.world;
        from.ends_at_tip() && {
            let last = from.count() - 1;
            let tip = world.support(from.contacts[last].stretch, from.t(last));
            world.contours_at(tip.x, tip.y, LIMITS.end.between_objects) > 1
        }
    }
}

/// Whether the clamp is inside an object, or a contact has come so close to it that its force has no lever.
fn is_clamp_inside(next: &Configuration, scan: &Scan) -> bool {
    scan.clamp_inside || (next.count() > 0 && next.s(0) < LIMITS.end.at_clamp)
}

/// Whether tau falls somewhere within a step although it grows at both ends, by the cubic of the step: there are two folds on the
/// way. A single fold shows in the slope at the end.
fn turns_twice(from: &Point, next: &Configuration, after: &Tangent, length: f64) -> bool {
    let chord = (next.tau() - from.configuration.tau()) / length;
    let stretch = from.tangent.component(&after.direction);
    let (first, last) = (from.tangent.by_tau(), after.by_tau() / stretch);
    // next to buckling tau hardly changes at all, and falls by rounding
    last > 0.0 && least_rate([first, last], chord).is_some_and(|least| least < -LIMITS.step.least_tau_rate)
}
