//! The loop of the continuation: one step along a branch, halved until it is accepted.

use crate::contact_set::Configuration;
use crate::continuation::branch::Corrector;
use crate::continuation::certify::Quality;
use crate::continuation::transition::Transition;
use crate::continuation::{Change, Corrected, Point, Seen, Step};
use crate::error::{Obstacle, StopReason};
use crate::friction::sliding::slide_new_contacts;
use crate::gap::{Scan, Scanner};
use crate::limits::LIMITS;
use rod_core::{PhysicalRod, Rod};

/// Why a step is not taken.
pub(super) enum Refused {
    /// A shorter one may be.
    TooLong(Obstacle),
    /// The branch ends within the step: no shorter one would be taken either.
    Ended(StopReason),
}

/// Follows branches.
#[derive(Debug)]
pub(crate) struct Stepper<'a, R = Rod> {
    pub corrector: Corrector<'a, R>,
    pub scanner: Scanner,
    /// Length of the next step.
    pub h: f64,
    /// How many more steps may be tried.
    pub steps_left: u64,
}

impl<'a, R: PhysicalRod> Stepper<'a, R> {
    pub fn new(corrector: Corrector<'a, R>, steps_left: u64) -> Self {
        Self { corrector, scanner: Scanner::default(), h: LIMITS.step.first, steps_left }
    }

    /// One step from `from` towards the pose `target`, at most there: halved while it is refused.
    pub fn step(&mut self, from: &Point, target: f64) -> Result<Step, StopReason> {
        let (mut obstacle, mut touches) = (Obstacle::NotConverged, false);
        while self.h >= LIMITS.step.shortest {
            self.steps_left = self.steps_left.checked_sub(1).ok_or(StopReason::StepBudget)?;
            obstacle = match self.attempt(from, target) {
                Ok(step) => return Ok(step),
                Err(Refused::Ended(reason)) => return Err(reason),
                Err(Refused::TooLong(obstacle)) => obstacle,
            };
            touches = obstacle.touches().unwrap_or(touches);
            self.h *= 0.5;
        }
        self.end_of_shortest_step(from, obstacle, touches)
    }

    /// A step of the present length: the steps of `docs/sweep.md`, section 3, in their order.
    fn attempt(&mut self, from: &Point, target: f64) -> Result<Step, Refused> {
        // Predict along the tangent, and correct by Newton's method.
        let prediction = self.predict(from, target);
        let corrected = self.correct(from, prediction, target).ok_or(Refused::TooLong(Obstacle::NotConverged))?;

        // Refuse a step within which the branch may have turned or a condition may have been broken.
        self.check_course(from, &corrected)?;

        // Look: scan the gap, and end the branch where the scan shows its end.
        let scan = self.scan_corrected(from, &corrected);
        self.check_ends(from, &corrected, &scan)?;

        // Locate the violated conditions. The first one along the branch ends the step.
        let ended = self.locate_first(from, &corrected, &scan)?;

        // Refuse a step on which the rod or its clamp has passed over an object, up to where the step ends.
        self.check_passing(from, &corrected, &scan, ended.as_ref())?;
        if let Some(ended) = ended {
            return Ok(ended);
        }

        // Certify the stability of the new equilibrium.
        let Corrected { next, tangent, report, length, .. } = corrected;
        if !self.is_stable(&next, &scan) {
            let long = length > LIMITS.probe.way;
            return if long { Err(Refused::TooLong(Obstacle::Unstable)) } else { Ok(self.end_of_stability(from)) };
        }

        // Merge two contacts that are about to become one.
        if let Some(transition) = self.merge_contacts(&next, &tangent) {
            return Ok(self.step_to(transition));
        }

        // Lengthen the next step after an easy solve.
        if report.iterations <= 2 {
            self.h = (2.0 * self.h).min(LIMITS.step.longest);
        }
        let quality = Quality::new(&report, true);
        Ok(Step::Moved(Box::new(Point { configuration: next, scan, quality, tangent })))
    }

    /// The scan at the end of a step. Of a free rod, the ends of open contours stay on the sides on which they were.
    fn scan_corrected(&mut self, from: &Point, corrected: &Corrected) -> Scan {
        let mut scan = self.scan(&corrected.next);
        if corrected.next.count() == 0 {
            scan.keep_sides(&from.scan);
        }
        scan
    }

    pub fn scan(&mut self, configuration: &Configuration) -> Scan {
        self.scanner.scan(&self.corrector.setup, configuration)
    }

    pub fn is_stable(&mut self, configuration: &Configuration, scan: &Scan) -> bool {
        self.scanner.is_stable(&self.corrector.setup, configuration, scan)
    }

    /// A configuration at a transition with its scan. Where all contacts slide, new ones do from there on.
    pub fn look(&mut self, mut configuration: Configuration) -> Seen {
        slide_new_contacts(&self.corrector.setup.world, &mut configuration);
        let scan = self.scanner.scan_transition(&self.corrector.setup, &configuration);
        Seen { configuration, scan }
    }

    /// The point of a configuration: its tangent at the pose, its quality and its stability.
    pub fn point(&mut self, Seen { configuration, scan }: Seen) -> Point {
        let (tangent, report) = self.corrector.inspect_at_pose(&configuration);
        let stable = self.is_stable(&configuration, &scan);
        Point { configuration, scan, quality: Quality::new(&report, stable), tangent }
    }

    /// A transition, with the scan of the contact set after it, as the end of a step.
    pub(super) fn step_to(&mut self, Transition { kind, before, after, .. }: Transition) -> Step {
        let after = self.look(after);
        Step::Changed(Box::new(Change { kind, before, after }))
    }
}
