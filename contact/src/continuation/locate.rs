//! Look for the transitions within a step, and locate the first one along the branch.

use crate::contact_set::Configuration;
use crate::continuation::Corrected;
use crate::continuation::branch::{Condition, Tangent};
use crate::continuation::dip::may_lie_down;
use crate::continuation::ends::{end_if_short, obstacle_of};
use crate::continuation::fold::{locate_fold, locate_zero};
use crate::continuation::inflection::split_at_inflection;
use crate::continuation::stepper::{Refused, Stepper};
use crate::continuation::transition::{Break, NoTransition, Transition, breaks};
use crate::continuation::{Point, Seen, Step};
use crate::error::StopReason;
use crate::event::EventKind;
use crate::friction::{reversed_slips, slip_rate};
use crate::gap::Scan;
use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::scene::rod::Segment;
use crate::stability::{clearance, wraps};
use rod_core::{PhysicalRod, RodModel};
use smallvec::SmallVec;

impl<R: PhysicalRod> Stepper<'_, R> {
    /// The first transition within a step, where there is one: the end of the step. The step is refused where a transition is seen and not
    /// located.
    pub(super) fn locate_first(
        &mut self,
        from: &Point,
        corrected: &Corrected,
        scan: &Scan,
    ) -> Result<Option<Step>, Refused> {
        let end_if_short = |reason| Err(end_if_short(corrected.length, reason, obstacle_of(scan)));
        match self.first_transition(from, corrected, scan) {
            Ok(None) if !scan.is_outside() => Err(Refused::TooLong(obstacle_of(scan))),
            Ok(ended) => Ok(ended),
            Err(NoTransition::EndOfContour) => end_if_short(StopReason::EndOfContour),
            Err(NoTransition::FrictionInNotch) => end_if_short(StopReason::FrictionInNotch),
            Err(NoTransition::NotLocated) => Err(Refused::TooLong(obstacle_of(scan))),
        }
    }

    /// The first of all transitions within a step: of a violated condition of the contact set, a contact that comes to rest, a contact that
    /// lies down along a line, and a fold.
    fn first_transition(
        &mut self,
        from: &Point,
        corrected: &Corrected,
        scan: &Scan,
    ) -> Result<Option<Step>, NoTransition> {
        let Corrected { next, tangent, length, kink, .. } = corrected;
        // Violated conditions of the contact set.
        let mut first = self.first_break(from, next, scan, *length)?;

        // Contacts that slip and come to rest.
        if let Some(stick) = self.first_stick(from, next, tangent)?
            && first.as_ref().is_none_or(|first| stick.along < first.along)
        {
            first = Some(stick);
        }
        let is_first = |along: f64| first.as_ref().is_none_or(|first| along < first.along);

        // A contact that lies down along a line.
        if let Some((along, step)) = self.line_contact(from, corrected, scan.segments())?
            && is_first(along)
        {
            return Ok(Some(step));
        }

        // The fold.
        if tangent.by_tau() < 0.0 {
            // behind a kink the branch may lead back at once
            let fold = if *kink {
                next.clone()
            } else {
                locate_fold(&mut self.corrector, &from.configuration, &from.tangent, next)
                    .ok_or(NoTransition::NotLocated)?
            };
            if is_first(from.tangent.along(&fold.z, &from.configuration.z)) {
                let fold = self.look_if_valid(fold).ok_or(NoTransition::NotLocated)?;
                return Ok(Some(Step::Ended(Box::new(fold))));
            }
        }

        // Certify the contact set after it. Nothing else may be broken there: a shorter step would have met it first.
        let Some(transition) = first else { return Ok(None) };
        if !is_ordered_or_new(&transition.after) {
            return Err(NoTransition::NotLocated);
        }
        let step = self.step_to(transition);
        if step.scan().is_outside() { Ok(Some(step)) } else { Err(NoTransition::NotLocated) }
    }

    /// The first of the conditions of the contact set that are violated at the end of a step, located.
    fn first_break(
        &mut self,
        from: &Point,
        next: &Configuration,
        scan: &Scan,
        length: f64,
    ) -> Result<Option<Transition>, NoTransition> {
        let mut broken: SmallVec<[Break; 4]> = SmallVec::new();
        breaks(&self.corrector.setup.world, next, &scan.crossings, |b| broken.push(b));
        let slack = LIMITS.transition.slack + LIMITS.transition.relative_slack * length;
        let mut first: Option<Transition> = None;
        // A straight rod comes to lie on a straight edge everywhere at once: what holds it then is the point next to
        // the clamp.
        broken.sort_by(|a, b| a.s().total_cmp(&b.s()));
        for b in broken {
            let transition = b.locate(&mut self.corrector, next, &from.configuration, &from.tangent)?;
            let before = if let Break::Touch(_) = b { LIMITS.transition.touch_slack } else { slack };
            if !(-before..=length + slack).contains(&transition.along) {
                return Err(NoTransition::NotLocated);
            }
            if first.as_ref().is_none_or(|first| transition.along < first.along - LIMITS.transition.at_once) {
                first = Some(transition);
            }
        }
        Ok(first)
    }

    /// Where the first contact that slips comes to rest within the step to `next`, if one does.
    fn first_stick(
        &mut self,
        from: &Point,
        next: &Configuration,
        tangent: &Tangent,
    ) -> Result<Option<Transition>, NoTransition> {
        let mut first: Option<Transition> = None;
        let slowed: SmallVec<[(usize, f64); 2]> = reversed_slips(&self.corrector.setup.world, next, tangent).collect();
        for (j, ratio) in slowed {
            let forward = |setup: &Setup<'_, R>, here: &Configuration, there: &Tangent| {
                -ratio.signum() * slip_rate(&setup.world, here, there, j)
            };
            let at = locate_zero(&mut self.corrector, &from.configuration, &from.tangent, next, forward)
                .ok_or(NoTransition::NotLocated)?;
            let along = from.tangent.along(&at.z, &from.configuration.z);
            if first.as_ref().is_none_or(|first| along < first.along) {
                let mut after = at.clone();
                after.set_sticking(j, at.friction(j));
                first = Some(Transition { kind: EventKind::Stick, before: at, after, along });
            }
        }
        Ok(first)
    }

    /// Where a contact comes to lie along a line within a step, if one does, and the end of the step there: the contact splits in two at an
    /// inflection of the contour, or the branch ends.
    fn line_contact(
        &mut self,
        from: &Point,
        Corrected { next, tangent, length, kink, .. }: &Corrected,
        segments: &[Segment],
    ) -> Result<Option<(f64, Step)>, NoTransition> {
        let setup = &self.corrector.setup;
        let Some(j) = wraps(setup, next, segments) else {
            let (here, there) = ((&from.configuration, &from.tangent), (next, tangent));
            let between = !kink && may_lie_down(setup, here, there, [from.scan.segments(), segments], *length);
            return if between { Err(NoTransition::NotLocated) } else { Ok(None) };
        };
        let above =
            |setup: &Setup<'_, R>, here: &Configuration, _: &Tangent| clearance(setup, here, &here.segments(setup), j);
        let at = locate_zero(&mut self.corrector, &from.configuration, &from.tangent, next, above)
            .ok_or(NoTransition::NotLocated)?;
        let along = from.tangent.along(&at.z, &from.configuration.z);
        // there the gap beside the contact is of the third order, and nothing proves it
        let mut holds = true;
        breaks(&self.corrector.setup.world, &at, &[], |_| holds = false);
        let at = if holds { self.look(at) } else { return Err(NoTransition::NotLocated) };
        // between contacts a rod without friction jumps to another place, if there is one
        if j + 1 < next.count() && !next.rubs() {
            return Ok(Some((along, Step::Ended(Box::new(at)))));
        }
        // a rod that is bent at rest may go on along a line, from the contact to its tip
        if !self.may_split(&from.configuration) {
            return Ok(Some((along, Step::Stopped(StopReason::LineContact, Box::new(at)))));
        }
        let split = split_at_inflection(&mut self.corrector, &at.configuration);
        Ok(Some((along, split.map_or_else(|| Step::Ended(Box::new(at)), |transition| self.step_to(transition)))))
    }

    /// Whether the last contact may split into two: where the rod is straight at rest, and does not roll there.
    fn may_split(&self, from: &Configuration) -> bool {
        let rolls = from.contacts.last().is_some_and(|last| last.grip.sticks());
        self.corrector.setup.rod.model().is_straight() && !rolls
    }

    /// The configuration with its scan, if no condition of its contact set is violated.
    fn look_if_valid(&mut self, configuration: Configuration) -> Option<Seen> {
        let seen = self.look(configuration);
        let mut is_valid = seen.scan.is_outside();
        breaks(&self.corrector.setup.world, &seen.configuration, &seen.scan.crossings, |_| is_valid = false);
        is_valid.then_some(seen)
    }

    /// The end of the branch at `from`, from where it is not stable any more. Mostly a fold, or the place where a contact lies down, is just
    /// ahead, and known better than the loss of stability is.
    pub(super) fn end_of_stability(&mut self, from: &Point) -> Step {
        self.end_ahead(from).unwrap_or_else(|| from.end())
    }

    /// The fold that follows `from` closely, or the place where a contact lies down along a line or comes to rest, if there is one.
    fn end_ahead(&mut self, from: &Point) -> Option<Step> {
        let Point { configuration, tangent, .. } = from;
        for distance in LIMITS.end.ahead {
            let mut next = tangent.ahead(configuration, distance);
            let plane = Condition::Plane { tangent, from: &configuration.z, distance };
            let report = self.corrector.correct(&mut next, plane);
            if !report.status.is_solved() {
                return None;
            }
            let after = self.corrector.inspect(&next, plane).0;
            let scan = self.scan(&next);
            let ahead = Corrected { next, tangent: after, report, length: distance, kink: false };
            match self.first_transition(from, &ahead, &scan) {
                Ok(None) => {}
                Ok(Some(Step::Changed(change))) if change.kind != EventKind::Stick => return None,
                Ok(step) => return step,
                Err(_) => return None,
            }
        }
        None
    }
}

/// Whether the contacts follow each other along the rod; a new one may still be at the same place as its neighbour.
fn is_ordered_or_new(configuration: &Configuration) -> bool {
    let n = configuration.count();
    (1..n).all(|j| configuration.s(j) >= configuration.s(j - 1))
}
