//! The loop of the sweep: one round at a time, from a point of a branch to the next.

use super::resume::Departure;
use super::rubbing::contact_at_rest;
use super::{Stage, Sweep};
use crate::contact_set::edit::{beside_corner, over_sliver};
use crate::contact_set::{ActiveContact, Configuration};
use crate::continuation::{Change, Point, Seen, Step};
use crate::error::StopReason;
use crate::event::EventKind;
use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::scene::world::World;
use crate::stability::wraps;
use rod_core::{Clamp, PhysicalRod};

impl<R: PhysicalRod> Sweep<'_, R> {
    /// One round: the first point of a leg, or from one point of a branch to the next. States and events to report are then pending.
    pub(super) fn advance(&mut self) -> Result<(), StopReason> {
        match std::mem::replace(&mut self.stage, Stage::Over(None)) {
            Stage::Begins(given) => self.begin_leg(given.map(|given| *given)),
            Stage::At(point, step) => self.go_on(point, step),
            over @ Stage::Over(_) => {
                self.stage = over;
                Ok(())
            }
        }
    }

    /// The first point of a leg: of the given equilibrium, or of the one that is found in the first pose.
    fn begin_leg(&mut self, given: Option<Departure>) -> Result<(), StopReason> {
        let Setup { world, path, rod } = self.setup();
        if world.rubs() && rod.clamp(path.at(0.0)).roller().is_some() {
            return Err(StopReason::RollerFriction);
        }
        let (start, step) = match given {
            Some(given) => self.resume(given)?,
            None => self.find_start()?,
        };
        if self.course.is_new() {
            self.report(&start);
        }
        self.stage = Stage::At(Box::new(start), step);
        Ok(())
    }

    /// Goes on from a point of a branch, where the `step` from there may be known from the last round. The branch is followed by steps of its
    /// own, each to the transition that ends it; the poses to report lie on them and have no part in where a step ends.
    fn go_on(&mut self, point: Box<Point>, step: Option<Step>) -> Result<(), StopReason> {
        // Report the state at this very pose, if one is due.
        self.pass_poses_before(&point);
        if self.is_due_at(&point) {
            self.report(&point);
            self.stage = Stage::At(point, step);
            return Ok(());
        }
        let end = self.setup().path.length();
        if point.configuration.tau() >= end - LIMITS.step.same_pose {
            return self.end_leg(point);
        }

        // Predict, correct, look for transitions, locate the first and certify: one step of the branch (`Stepper::attempt`).
        let mut step = match step {
            Some(step) => Ok(step),
            None => self.stepper.step(&point, end),
        };

        // Report a state between the ends of the step, if one is due; the step waits for the next round.
        let pose = self.pose();
        if let Ok(taken) = &step
            && self.course.is_due()
            && pose < taken.tau() + taken.rounding()
        {
            if let Some(state) = self.stepper.between(&point, taken, pose) {
                self.hand_out(pose, state);
                self.stage = Stage::At(point, step.ok());
                return Ok(());
            }
            if pose < taken.tau() {
                // the step has passed over something
                step = self.stepper.step(&point, pose);
            }
        }

        // Change the contact set at the transition, or snap at the end of the branch: the next point. The last one is kept for the message.
        let next = step.and_then(|step| self.follow(&point, step));
        let (stage, done) = match next {
            Ok(next) => (Stage::At(next, None), Ok(())),
            Err(reason) => (Stage::Over(Some(point)), Err(reason)),
        };
        self.stage = stage;
        done
    }

    /// Leaves out the poses to report that a snap has jumped over: there is no equilibrium.
    fn pass_poses_before(&mut self, point: &Point) {
        while self.course.is_due() && self.pose() < point.configuration.tau() - self.slack() {
            self.course.pass();
        }
    }

    /// Whether the state at the pose of a point is to be reported.
    fn is_due_at(&self, point: &Point) -> bool {
        self.course.is_due() && self.pose() <= point.configuration.tau() + LIMITS.step.same_pose
    }

    /// At the end of a leg the next one begins, or all is over.
    fn end_leg(&mut self, point: Box<Point>) -> Result<(), StopReason> {
        let path = &self.setup().path;
        let is_beyond = point.configuration.tau() > path.length() + LIMITS.sweep.at_end;
        let passed = path.parameter(path.length(), self.setup().rod.units().length);
        let departure = Departure::from_end(&point);
        self.stage = Stage::Over(Some(point));
        if self.course.is_last() {
            return Ok(());
        }
        // a snap has landed further along this leg than it goes: there is no equilibrium from which to set out
        if is_beyond {
            return Err(StopReason::NoLanding);
        }
        if let Some(way) = self.course.next_leg(passed) {
            self.set_out(way, departure);
        }
        Ok(())
    }

    /// The point to which a step leads: its end, the point of the new contact set at a transition, or where the rod lands after a snap.
    pub(super) fn arrive(&mut self, step: Step) -> Result<Box<Point>, StopReason> {
        match step {
            Step::Moved(next) => Ok(next),
            Step::Changed(change) => self.change(*change),
            Step::Stopped(reason, last) => {
                self.reached = last.configuration.tau();
                Err(reason)
            }
            Step::Ended(last) => {
                self.crowd.count(&last.configuration, &self.stepper.corrector.setup.world)?;
                self.snap(*last).map(Box::new)
            }
        }
    }

    /// Changes the contact set at a transition and certifies that the new one holds further along the path. Where it does not, the rod snaps.
    fn change(&mut self, Change { kind, before, after }: Change) -> Result<Box<Point>, StopReason> {
        self.crowd.count(&after.configuration, &self.stepper.corrector.setup.world)?;
        // a corner at the very tip is none
        let beside = beside_corner(&after.configuration, &self.setup().world);
        self.stepper.h = LIMITS.step.first;
        let stopped = contact_at_rest(kind, &before, &after.configuration);
        let onto = (kind == EventKind::Piece).then(|| after.configuration.clone());
        let before = self.stepper.look(before);

        // Certify the new contact set, with friction in the modes that the path allows.
        let mut next = if self.setup().world.rubs() {
            self.continue_rubbing(after, stopped)?
        } else {
            self.continue_with(after).or_else(|| beside.into_iter().find_map(|beside| self.continue_as(beside)))
        };
        if let (None, Some(onto)) = (&next, &onto) {
            next = self.beyond_sliver(&before.configuration, onto)?;
        }

        // Report the event.
        if let Some(after) = next {
            let before = self.stepper.point(before);
            self.announce(kind, &before, &after);
            return Ok(Box::new(after));
        }

        // Stop where a contact that has come to another piece can neither go on nor leave; otherwise snap.
        if let Some(onto) = onto {
            if self.lies_down(&onto) {
                self.reached = onto.tau();
                return Err(StopReason::LineContact);
            }
            if self.is_held_at_border(&before.configuration, &onto) {
                return Err(StopReason::RougherPiece);
            }
        }
        self.snap(before).map(Box::new)
    }

    /// Whether a contact lies along a line.
    fn lies_down(&self, configuration: &Configuration) -> bool {
        wraps(self.setup(), configuration, &configuration.segments(self.setup())).is_some()
    }

    /// The point behind a piece or corner that is too small to follow, which a contact has come to from another one.
    fn beyond_sliver(&mut self, before: &Configuration, after: &Configuration) -> Result<Option<Point>, StopReason> {
        let Some(beyond) = over_sliver(before, after, &self.setup().world) else { return Ok(None) };
        let seen = self.stepper.look(beyond);
        self.continue_from(seen)
    }

    /// The point from which the sweep goes on with the contacts of `seen`, with or without friction.
    pub(super) fn continue_from(&mut self, seen: Seen) -> Result<Option<Point>, StopReason> {
        if self.setup().world.rubs() { self.continue_rubbing(seen, None) } else { Ok(self.continue_with(seen)) }
    }

    /// The point of a new contact set, if the sweep can go on with it.
    pub(super) fn continue_with(&mut self, seen: Seen) -> Option<Point> {
        let point = self.stepper.point(seen);
        self.stepper.goes_on(&point).then_some(point)
    }

    fn continue_as(&mut self, configuration: Configuration) -> Option<Point> {
        let seen = self.stepper.look(configuration);
        self.continue_with(seen)
    }

    /// The point of a configuration.
    pub(super) fn point_of(&mut self, configuration: Configuration) -> Point {
        let seen = self.stepper.look(configuration);
        self.stepper.point(seen)
    }
}

/// Where the last transition was, and how many there were at that pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crowd {
    tau: f64,
    count: usize,
}

impl Crowd {
    pub const NONE: Self = Self { tau: f64::NAN, count: 0 };

    /// Counts a transition.
    pub fn count(&mut self, reached: &Configuration, world: &World<'_>) -> Result<(), StopReason> {
        let tau = reached.tau();
        let count = if (tau - self.tau).abs() < LIMITS.sweep.one_pose { self.count + 1 } else { 0 };
        *self = Self { tau, count };
        if count <= LIMITS.sweep.most_at_one_pose {
            return Ok(());
        }
        // an open contour that is met head-on at its end has no side to rest on
        let at_end = |(held, j): (&ActiveContact, usize)| {
            let at = world.support(held.stretch, reached.t(j));
            world.open_ends().iter().any(|(x, y)| (at.x - x).hypot(at.y - y) < LIMITS.sweep.at_open_end)
        };
        let by_an_end = reached.contacts.iter().zip(0..).any(at_end);
        Err(if by_an_end { StopReason::EndOfContour } else { StopReason::Chatter })
    }
}
