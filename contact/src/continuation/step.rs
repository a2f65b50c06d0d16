//! One step along a branch: predict, correct, look for what broke, locate the first transition.

use crate::contact_set::order::ordered;
use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::{Condition, Corrector, LEAST_COSINE, Tangent};
use crate::continuation::certify::Quality;
use crate::continuation::dip::{dips, least_rate, may_lie_down};
use crate::continuation::fold::{locate_fold, locate_zero};
use crate::continuation::inflection::{parted, run_together};
use crate::continuation::joint::{self, Passed};
use crate::continuation::transition::{Break, NoTransition, Transition, breaks, gathered, on, range_of_force};
use crate::error::{Obstacle, StopReason};
use crate::event::EventKind;
use crate::friction::{reversed, slip_rate};
use crate::gap::passing::Passing;
use crate::gap::scan::{Scan, Scanner};
use crate::scene::rod::Segment;
use crate::scene::setup::Setup;
use crate::stability::{clearance, wraps};
use rod_core::{Clamp, PhysicalRod, Rod, RodModel, SolveReport};
use smallvec::SmallVec;

/// Distance (path parameter) of two poses that count as one. A pose so little beyond a transition reports the state before it.
pub(crate) const SAME_POSE: f64 = 1e-13;
/// Length of a step (arclength) below which the end of a contour, or the clamp at an object, that the step meets is accepted as
/// the end of the sweep. A longer step is halved first.
const SHORT: f64 = 1e-3;
/// Longest steps of a rod in contact: in arclength of the branch (lengths, angles, relative forces) and in the path parameter.
/// Longer ones are halved more often and may pass over contacts that come and go.
const LONGEST_STEP: f64 = 0.3;
const LONGEST_WAY: f64 = 0.05;
/// Way (L) that a step of a free rod may go beyond its gap. A contact that begins and ends within it is missed.
const FREE_STEP: f64 = 2e-3;
/// First step on a new branch, in arclength.
pub(crate) const FIRST_STEP: f64 = 0.02;
/// Shortest step (arclength). Where it fails too, the sweep stops with `StepTooSmall`.
const SHORTEST_STEP: f64 = 1e-9;
/// Distance (L) of two contacts on one piece from which on they are tried as one, and ways along the path (L) that this may take. The
/// distance falls with the root of the way that is left, and the equations of both lose digits with its third power.
const CLOSE: f64 = 4e-3;
const JOINED: [f64; 7] = [0.0, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5];
/// Distance (L) of the tip from two objects at which it counts as caught between them.
const BETWEEN: f64 = 1e-6;
/// Largest distance of the corrected from the predicted point, over the length of the step. A larger one may be another branch.
pub(crate) const LARGEST_CORRECTION: f64 = 0.3;
/// Least d tau / d arclength at which a step aims at a pose. Closer to a fold the pose is ill-conditioned.
pub(crate) const STEEPEST: f64 = 1e-3;
/// Depth (L) of a free rod beyond that of rounding.
const DEEPEST: f64 = 1e-9;
/// Largest residual of a solution (L, rad). The Newton method scales its own tolerance by the forces; this limits it.
pub(crate) const LARGEST_RESIDUAL: f64 = 1e-9;
/// Arc length (L) below which a contact counts as at the clamp, where its force has no lever.
const AT_CLAMP: f64 = 1e-4;
/// The same beyond a roller, whose force grows with the inverse of it; and what counts as at the roller where the branch cannot be followed
/// any more.
const AT_ROLLER: f64 = 1e-2;
const NEAR_ROLLER: f64 = 6e-2;
/// Arclength within which transitions coincide. The one next to the clamp is taken.
const AT_ONCE: f64 = 1e-12;
/// Arclength by which a touch may lie before the start of the step. The proof at the start leaves a depth of 1e-12 L open, which
/// a slowly closing gap takes so long to pass.
pub(crate) const BEFORE: f64 = 1e-6;
/// Arclength below which a step is not tested for thin things that it passes over: what is thinner is not met anyway.
const LEAST_SWEPT: f64 = 1e-8;
/// Way along the path, and longest way along the branch, after which a new contact set must still hold.
const PROBE: f64 = 1e-6;
const PROBES: [f64; 3] = [PROBE, 1e-8, 1e-10];
/// The same with friction. A contact with hardly any sticks for a short way only; its force changes so fast that a longer probe fails, and
/// a shorter one tells rounding.
const RUBBING_PROBES: [f64; 5] = [PROBE, 1e-7, 1e-8, 1e-10, 1e-12];
const FARTHEST_PROBE: f64 = 1e-3;

/// A point of the sweep: an equilibrium, what the scan saw, and where the branch goes from there.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub configuration: Configuration,
    pub scan: Scan,
    pub quality: Quality,
    pub tangent: Tangent,
}

/// A configuration, and what the scan saw.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    pub configuration: Configuration,
    pub scan: Scan,
}

/// A transition, and what the scan saw of the contact set after it.
#[derive(Debug)]
pub(crate) struct Change {
    pub kind: EventKind,
    pub before: Configuration,
    pub after: Seen,
}

/// What a step came to.
#[derive(Debug)]
pub(crate) enum Step {
    /// A new point of the branch.
    Moved(Box<Point>),
    /// A transition before that.
    Changed(Box<Change>),
    /// The branch ends here, in a fold, or loses its stability.
    Ended(Box<Seen>),
    /// The branch can be followed up to here, and no further.
    Stopped(StopReason, Box<Seen>),
}

impl Point {
    /// The branch ends here.
    pub fn ends(&self) -> Step {
        Step::Ended(Box::new(Seen { configuration: self.configuration.clone(), scan: self.scan.clone() }))
    }
}

impl Step {
    /// The last configuration of the branch that was followed.
    pub fn last(&self) -> &Configuration {
        match self {
            Self::Moved(next) => &next.configuration,
            Self::Changed(change) => &change.before,
            Self::Ended(last) | Self::Stopped(_, last) => &last.configuration,
        }
    }

    /// What the scan saw at its end: of a transition, with the contact set after it.
    fn scan(&self) -> &Scan {
        match self {
            Self::Moved(next) => &next.scan,
            Self::Changed(change) => &change.after.scan,
            Self::Ended(last) | Self::Stopped(_, last) => &last.scan,
        }
    }

    /// Where the clamp is there.
    pub fn tau(&self) -> f64 {
        self.last().tau()
    }

    /// How far beyond its end a pose is at its end: a transition is located up to rounding. Beyond a fold there is nothing.
    pub fn rounding(&self) -> f64 {
        if let Self::Changed(_) = self { SAME_POSE } else { 0.0 }
    }
}

/// Why a step was not taken.
enum Refused {
    /// A shorter one may be.
    TooLong(Obstacle),
    /// Nor would any other.
    Ended(StopReason),
}

/// The next point of a branch, before it is judged.
struct Ahead {
    next: Configuration,
    tangent: Tangent,
    report: SolveReport,
    /// Arclength of the step along the first tangent.
    length: f64,
    /// Whether the branch has a kink there, and `tangent` is that behind it.
    kink: bool,
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
        Self { corrector, scanner: Scanner::default(), h: FIRST_STEP, steps_left }
    }

    /// A look at a configuration at a transition.
    pub fn look(&mut self, configuration: Configuration) -> Seen {
        let scan = self.scanner.scan_transition(&self.corrector.setup, &configuration);
        Seen { configuration, scan }
    }

    /// A point with everything known of it.
    pub fn point(&mut self, Seen { configuration, scan }: Seen) -> Point {
        let (tangent, report) = self.corrector.inspect_at_pose(&configuration);
        let stable = self.is_stable(&configuration, &scan);
        Point { configuration, scan, quality: Quality::new(&report, stable), tangent }
    }

    pub fn scan(&mut self, configuration: &Configuration) -> Scan {
        self.scanner.scan(&self.corrector.setup, configuration)
    }

    pub fn is_stable(&mut self, configuration: &Configuration, scan: &Scan) -> bool {
        self.scanner.is_stable(&self.corrector.setup, configuration, scan)
    }

    /// One step from `from` towards the pose `target`, at most there.
    pub fn step(&mut self, from: &Point, target: f64) -> Result<Step, StopReason> {
        let (mut obstacle, mut touches) = (Obstacle::NotConverged, false);
        while self.h >= SHORTEST_STEP {
            self.steps_left = self.steps_left.checked_sub(1).ok_or(StopReason::StepBudget)?;
            obstacle = match self.attempt(from, target) {
                Ok(step) => return Ok(step),
                Err(Refused::Ended(reason)) => return Err(reason),
                Err(Refused::TooLong(obstacle)) => obstacle,
            };
            touches = obstacle.touches().unwrap_or(touches);
            self.h *= 0.5;
        }
        // Behind the end of an open contour there is no telling inside from outside.
        if from.scan.is_by_an_end() {
            return Err(StopReason::EndOfContour);
        }
        if self.is_before_roller(&from.configuration, &from.scan, NEAR_ROLLER) {
            return Err(StopReason::BeforeRoller);
        }
        // Where rod and contour are both without curvature, a touch has no isolated solution: the descent finds what follows it.
        if touches {
            return Ok(from.ends());
        }
        if self.is_between_objects(&from.configuration) {
            return Err(StopReason::BetweenObjects);
        }
        Err(StopReason::StepTooSmall(obstacle))
    }

    /// Whether the tip lies on more than one object.
    fn is_between_objects(&self, from: &Configuration) -> bool {
        let world = &self.corrector.setup.world;
        from.ends_at_tip() && {
            let last = from.count() - 1;
            let tip = world.support(from.contacts[last].stretch, from.t(last));
            world.contours_at(tip.x, tip.y, BETWEEN) > 1
        }
    }

    /// A step of the present length.
    fn attempt(&mut self, from: &Point, target: f64) -> Result<Step, Refused> {
        let Ahead { next, tangent, report, length, kink } =
            self.predict_and_correct(from, target).ok_or(Refused::TooLong(Obstacle::NotConverged))?;
        let bends =
            tangent.cosine(&from.tangent.direction) < LEAST_COSINE || turns_twice(from, &next, &tangent, length);
        if bends && !kink {
            return Err(Refused::TooLong(Obstacle::Turns));
        }
        if !kink && dips(&self.corrector.setup.world, (&from.configuration, &from.tangent), (&next, &tangent), length) {
            return Err(Refused::TooLong(Obstacle::NotLocated));
        }
        let mut scan = self.scan(&next);
        if next.count() == 0 {
            scan.keep_sides(&from.scan);
        }
        let unexplained = if scan.crossings.is_empty() { Obstacle::NotLocated } else { Obstacle::Touch };
        let ends_if_short = |reason| {
            if length < SHORT { Refused::Ended(reason) } else { Refused::TooLong(unexplained) }
        };
        if scan.clamp_inside || (next.count() > 0 && next.s(0) < AT_CLAMP) {
            return Err(ends_if_short(StopReason::ClampInside));
        }
        if self.is_before_roller(&next, &scan, AT_ROLLER) {
            return Err(ends_if_short(StopReason::BeforeRoller));
        }
        // No point of a free rod has gone further than the smallest gap was: it came around an end.
        let is_open = !self.corrector.setup.world.open_ends().is_empty();
        let is_free = next.count() == 0 && length * self.fastest() <= from.scan.gap.lower;
        if is_open && is_free && scan.gap.seen < -DEEPEST {
            return Err(Refused::Ended(StopReason::EndOfContour));
        }
        if scan.has_swept_over_an_end(&from.scan) {
            return Err(ends_if_short(StopReason::EndOfContour));
        }
        let ended = match self.first_transition(from, &next, &scan, (&tangent, kink), length) {
            Ok(None) if !scan.is_outside() => return Err(Refused::TooLong(unexplained)),
            Ok(ended) => ended,
            Err(NoTransition::EndOfContour) => return Err(ends_if_short(StopReason::EndOfContour)),
            Err(NoTransition::FrictionInNotch) => return Err(ends_if_short(StopReason::FrictionInNotch)),
            Err(NoTransition::NotLocated) => return Err(Refused::TooLong(unexplained)),
        };
        let reached = ended.as_ref().map_or(&scan, Step::scan);
        match self.passes(from, reached, length) {
            None => {}
            Some(Passing::Rod) if ended.is_some() => return Err(Refused::TooLong(unexplained)),
            Some(Passing::Rod) => return Err(Refused::TooLong(Obstacle::PassesOver)),
            Some(Passing::Clamp) => return Err(ends_if_short(StopReason::ClampInside)),
        }
        if let Some(ended) = ended {
            return Ok(ended);
        }
        if !self.is_stable(&next, &scan) {
            let long = length > PROBE;
            return if long { Err(Refused::TooLong(Obstacle::Unstable)) } else { Ok(self.end(from)) };
        }
        if let Some(transition) = self.runs_together(&next, &tangent).or_else(|| self.joined(&next, &tangent)) {
            return Ok(self.changed(transition));
        }
        if report.iterations <= 2 {
            self.h = (2.0 * self.h).min(LONGEST_STEP);
        }
        let quality = Quality::new(&report, true);
        Ok(Step::Moved(Box::new(Point { configuration: next, scan, quality, tangent })))
    }

    /// Whether the rod goes through an object, or has a contact, between its clamp and the roller ahead, or `beyond` that.
    fn is_before_roller(&self, next: &Configuration, scan: &Scan, beyond: f64) -> bool {
        let setup = &self.corrector.setup;
        setup.clamp(next.tau()).roller().is_some_and(|roller| {
            let supports = next.supports(&setup.world);
            let hold = setup.problem(&supports, next.tau()).roller(next.of_contacts());
            let s = hold.map_or(roller.at, |hold| hold.s) + beyond;
            scan.crossings.iter().any(|crossing| crossing.s < s) || (next.count() > 0 && next.s(0) < s)
        })
    }

    /// What the rod, on its way to where it is seen `now`, has gone through and is beside.
    fn passes(&mut self, from: &Point, now: &Scan, length: f64) -> Option<Passing> {
        let (setup, far) = (&self.corrector.setup, length > LEAST_SWEPT);
        far.then(|| self.scanner.passes(setup, &from.configuration, &from.scan, now)).flatten()
    }

    /// The end of the branch at `from`, from where it is not stable any more. Mostly a fold, or the place where a contact lies down, is just
    /// ahead, and known better than the loss of stability is.
    fn end(&mut self, from: &Point) -> Step {
        self.end_ahead(from).unwrap_or_else(|| from.ends())
    }

    /// Where a contact comes to lie along a line on the way to `next`, if one does: there the rod, or what is straight of it, parts from it at
    /// an inflection of the contour, or cannot be followed any more.
    fn lies_down(
        &mut self,
        from: &Point,
        next: &Configuration,
        segments: &[Segment],
        (tangent, kink): (&Tangent, bool),
        length: f64,
    ) -> Result<Option<(f64, Step)>, NoTransition> {
        let setup = &self.corrector.setup;
        let Some(j) = wraps(setup, next, segments) else {
            let (here, there) = ((&from.configuration, &from.tangent), (next, tangent));
            let between = !kink && may_lie_down(setup, here, there, [from.scan.segments(), segments], length);
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
        if !self.may_part(&from.configuration) {
            return Ok(Some((along, Step::Stopped(StopReason::LineContact, Box::new(at)))));
        }
        let parted = parted(&mut self.corrector, &at.configuration);
        Ok(Some((along, parted.map_or_else(|| Step::Ended(Box::new(at)), |transition| self.changed(transition)))))
    }

    /// Whether the last contact may part into two: where the rod is straight at rest, and does not roll there.
    fn may_part(&self, from: &Configuration) -> bool {
        let rolls = from.contacts.last().is_some_and(|last| last.grip.sticks());
        self.corrector.setup.rod.model().is_straight() && !rolls
    }

    /// A transition with a look at the contact set after it.
    fn changed(&mut self, Transition { kind, before, after, .. }: Transition) -> Step {
        let after = self.look(after);
        Step::Changed(Box::new(Change { kind, before, after }))
    }

    /// The configuration, if no condition of its contact set is broken.
    fn clean(&mut self, configuration: Configuration) -> Option<Seen> {
        let seen = self.look(configuration);
        let mut clean = seen.scan.is_outside();
        breaks(&self.corrector.setup.world, &seen.configuration, &seen.scan.crossings, |_| clean = false);
        clean.then_some(seen)
    }

    /// Two contacts on one convex piece that run together, as one: where they are so close that the rod lies on the one alone as soon as
    /// the clamp has gone a little further. The force of the other vanishes on that way.
    fn joined(&mut self, next: &Configuration, tangent: &Tangent) -> Option<Transition> {
        let j = (1..next.count()).find(|&j| {
            let [before, rate] = [j - 1, j].map(|j| tangent.rate_of(Unknown::ArcLength(j)));
            let same = next.contacts[j - 1] == next.contacts[j] && !next.is_tip(j);
            same && next.s(j) - next.s(j - 1) < CLOSE && rate < before
        })?;
        let (weak, strong) = if next.force(j) < next.force(j - 1) { (j, j - 1) } else { (j - 1, j) };
        let mut one = next.clone();
        one.set(Unknown::Force(strong), next.force(j) + next.force(j - 1));
        one.remove(weak);
        JOINED.into_iter().find_map(|way| {
            let after = on(&mut self.corrector, one.clone(), Unknown::Path, next.tau() + way).ok()?;
            // proven as a state is, since the next one must be
            let scan = self.scan(&after);
            let mut holds = scan.is_outside() && self.is_stable(&after, &scan);
            breaks(&self.corrector.setup.world, &after, &scan.crossings, |_| holds = false);
            holds.then(|| Transition { kind: EventKind::Release, before: next.clone(), after, along: 0.0 })
        })
    }

    /// The last two contacts run together, if they are about to.
    fn runs_together(&mut self, next: &Configuration, tangent: &Tangent) -> Option<Transition> {
        let j = next.count().checked_sub(2)?;
        if next.ends_at_tip() {
            return (tangent.rate_of(Unknown::ArcLength(j)) > 0.0)
                .then(|| gathered(&mut self.corrector, next))
                .flatten();
        }
        let closes = tangent.rate_of(Unknown::ArcLength(j + 1)) < tangent.rate_of(Unknown::ArcLength(j));
        closes.then(|| run_together(&mut self.corrector, next)).flatten()
    }

    /// The next point of the branch, by the tangent and Newton's method: at `target` where it is near enough, else a
    /// step of pseudo-arclength. None: the step was too long.
    fn predict_and_correct(&mut self, from: &Point, target: f64) -> Option<Ahead> {
        let Point { configuration, tangent, scan, .. } = from;
        let tau = configuration.tau();
        let slope = tangent.by_tau();
        let to_go = if slope > STEEPEST { (target - tau) / slope } else { f64::INFINITY };
        // a free rod is safe as far as its gap reaches, and goes little further
        let reach = if configuration.count() == 0 {
            let fastest = self.fastest();
            (scan.gap.lower.clamp(0.0, 1.0) / fastest).max(self.h.min(FREE_STEP / fastest))
        } else {
            self.h.min(LONGEST_WAY / slope.abs()).min(self.to_border(from))
        };
        let mut land = to_go <= reach;
        let length = if land { to_go } else { reach };
        let mut next = tangent.ahead(configuration, length);
        if joint::passes(&self.corrector, configuration, &next) {
            return self.over_joint(from, &next, target, reach);
        }
        let predicted = next.z.clone();
        let condition = if land {
            Condition::Fixed { unknown: Unknown::Path, value: target }
        } else {
            Condition::Plane { tangent, from: &configuration.z, distance: length }
        };
        let (mut report, mut ahead) = self.corrector.correct_with_tangent(&mut next, condition);
        let off = tangent.distance(&next.z, &predicted);
        if !report.status.is_solved()
            || report.residual > LARGEST_RESIDUAL
            || !ordered(&self.corrector.setup.world, &next)
            || off > LARGEST_CORRECTION * length + 1e-9
        {
            return None;
        }
        if !land && next.tau() > target {
            // ran past it: the pose is between the two
            let part = (target - tau) / (next.tau() - tau);
            for (z, start) in next.z.iter_mut().zip(&configuration.z) {
                *z = start + part * (*z - start);
            }
            let at_pose = Condition::Fixed { unknown: Unknown::Path, value: target };
            (report, ahead) = self.corrector.correct_with_tangent(&mut next, at_pose);
            let length = tangent.along(&next.z, &configuration.z);
            if !report.status.is_solved()
                || !ordered(&self.corrector.setup.world, &next)
                || !(0.0..=reach).contains(&length)
            {
                return None;
            }
            land = true;
        }
        if land {
            // to the last bit, so that the sweep knows it has arrived
            next.set_tau(target);
        }
        let mut ahead = ahead?;
        if next.rubs() {
            // whether a contact still slips forward hangs on more digits than those of a Jacobian that is one correction old
            let own = if land { Condition::Fixed { unknown: Unknown::Path, value: target } } else { condition };
            ahead = self.corrector.inspect(&next, own).0;
        }
        if !joint::passes(&self.corrector, configuration, &next) {
            let length = tangent.along(&next.z, &configuration.z);
            return Some(Ahead { next, tangent: ahead, report, length, kink: false });
        }
        self.over_joint(from, &next, target, reach)
    }

    /// The point just behind the first joint on the way to `next`, if that is as near as a step may go.
    fn over_joint(&mut self, from: &Point, next: &Configuration, target: f64, reach: f64) -> Option<Ahead> {
        let Passed { configuration: next, tangent, report } =
            joint::passed(&mut self.corrector, (&from.configuration, &from.tangent), next)?;
        let length = from.tangent.along(&next.z, &from.configuration.z);
        let near = next.tau() <= target && (0.0..=2.0 * reach).contains(&length);
        let solved = report.residual <= LARGEST_RESIDUAL && ordered(&self.corrector.setup.world, &next);
        (near && solved).then_some(Ahead { next, tangent, report, length, kink: true })
    }

    /// Length of a step that takes a contact over the border of its stretch for certain, but not much further: there may be
    /// many short ones.
    fn to_border(&self, from: &Point) -> f64 {
        let Point { configuration, tangent, .. } = from;
        let step = |j: usize| {
            let (t, rate) = (configuration.t(j), tangent.rate_of(Unknown::Parameter(j)));
            // a tip that sticks has no border ahead, not even on one
            if rate == 0.0 || (configuration.is_tip(j) && configuration.contacts[j].grip.sticks()) {
                return f64::INFINITY;
            }
            let range = range_of_force(&self.corrector.setup.world, configuration.contacts[j].stretch);
            let border = if rate > 0.0 { range.to } else { range.from };
            1.5 * ((border - t) / rate).max(0.0) + PROBE
        };
        (0..configuration.count()).map(step).fold(f64::INFINITY, f64::min)
    }

    /// The fold that follows `from` closely, or the place where a contact lies down along a line or comes to rest, if there is one.
    fn end_ahead(&mut self, from: &Point) -> Option<Step> {
        let Point { configuration, tangent, .. } = from;
        for distance in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
            let mut next = tangent.ahead(configuration, distance);
            let plane = Condition::Plane { tangent, from: &configuration.z, distance };
            if !self.corrector.correct(&mut next, plane).status.is_solved() {
                return None;
            }
            let after = self.corrector.inspect(&next, plane).0;
            let scan = self.scan(&next);
            match self.first_transition(from, &next, &scan, (&after, false), distance) {
                Ok(None) => {}
                Ok(Some(Step::Changed(change))) if change.kind != EventKind::Stick => return None,
                Ok(step) => return step,
                Err(_) => return None,
            }
        }
        None
    }

    /// Fastest way of any point of a free rod by the path parameter: none is farther from the clamp than 1.
    fn fastest(&self) -> f64 {
        self.corrector.setup.path.fastest()
    }

    /// The first transition between `from` and `next`, where there is one.
    fn first_transition(
        &mut self,
        from: &Point,
        next: &Configuration,
        scan: &Scan,
        (tangent, kink): (&Tangent, bool),
        length: f64,
    ) -> Result<Option<Step>, NoTransition> {
        let mut broken: SmallVec<[Break; 4]> = SmallVec::new();
        breaks(&self.corrector.setup.world, next, &scan.crossings, |b| broken.push(b));
        let slack = 1e-9 + 1e-6 * length;
        let mut first: Option<Transition> = None;
        // A straight rod comes to lie on a straight edge everywhere at once: what holds it then is the point next to
        // the clamp.
        broken.sort_by(|a, b| a.s().total_cmp(&b.s()));
        for b in broken {
            let transition = b.locate(&mut self.corrector, next, &from.configuration, &from.tangent)?;
            let before = if let Break::Touch(_) = b { BEFORE } else { slack };
            if !(-before..=length + slack).contains(&transition.along) {
                return Err(NoTransition::NotLocated);
            }
            if first.as_ref().is_none_or(|first| transition.along < first.along - AT_ONCE) {
                first = Some(transition);
            }
        }
        if let Some(stopped) = self.stop_within(from, next, tangent)?
            && first.as_ref().is_none_or(|first| stopped.along < first.along)
        {
            first = Some(stopped);
        }
        // Nothing else may be broken there: a shorter step would have met it first.
        if let Some((along, step)) = self.lies_down(from, next, scan.segments(), (tangent, kink), length)?
            && first.as_ref().is_none_or(|first| along < first.along)
        {
            return Ok(Some(step));
        }
        if tangent.by_tau() < 0.0 {
            // behind a kink the branch may lead back at once
            let fold = if kink {
                next.clone()
            } else {
                locate_fold(&mut self.corrector, &from.configuration, &from.tangent, next)
                    .ok_or(NoTransition::NotLocated)?
            };
            let along = from.tangent.along(&fold.z, &from.configuration.z);
            if first.as_ref().is_none_or(|first| along < first.along) {
                let fold = self.clean(fold).ok_or(NoTransition::NotLocated)?;
                return Ok(Some(Step::Ended(Box::new(fold))));
            }
        }
        let Some(Transition { kind, before, after, .. }) = first else { return Ok(None) };
        if !ordered_or_new(&after) {
            return Err(NoTransition::NotLocated);
        }
        let after = self.look(after);
        let change = after.scan.is_outside().then(|| Box::new(Change { kind, before, after }));
        change.map(|change| Some(Step::Changed(change))).ok_or(NoTransition::NotLocated)
    }

    /// Where the first contact that slips comes to rest within the step to `next`, if one does.
    fn stop_within(
        &mut self,
        from: &Point,
        next: &Configuration,
        tangent: &Tangent,
    ) -> Result<Option<Transition>, NoTransition> {
        let mut first: Option<Transition> = None;
        let stopped: SmallVec<[(usize, f64); 2]> = reversed(&self.corrector.setup.world, next, tangent).collect();
        for (j, ratio) in stopped {
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

    /// Whether the sweep can go on with a new contact set: whether it still holds a little further along the path.
    pub fn goes_on(&mut self, point: &Point) -> bool {
        self.holds_for(point, &PROBES).is_some()
    }

    /// The same with friction: the number of the longest probe along the path on which it holds.
    pub fn goes_on_rubbing_for(&mut self, point: &Point) -> Option<usize> {
        self.holds_for(point, &RUBBING_PROBES)
    }

    /// The next transition may follow closely, but not at once.
    fn holds_for(&mut self, point: &Point, probes: &[f64]) -> Option<usize> {
        let leads_on = point.tangent.by_tau() > 0.0 && !runs_off(point);
        leads_on.then(|| probes.iter().position(|way| self.holds_ahead(point, *way))).flatten()
    }

    /// The stable equilibrium a little way along the tangent of a point at a fold, if the pose grows on that way.
    pub fn beyond_fold(&mut self, Point { configuration, tangent, .. }: &Point) -> Option<Configuration> {
        let mut probe = tangent.ahead(configuration, FARTHEST_PROBE);
        let plane = Condition::Plane { tangent, from: &configuration.z, distance: FARTHEST_PROBE };
        let solved = self.corrector.correct(&mut probe, plane).status.is_solved();
        if !solved || probe.tau() <= configuration.tau() {
            return None;
        }
        let scan = self.scan(&probe);
        self.is_stable(&probe, &scan).then_some(probe)
    }

    fn holds_ahead(&mut self, point: &Point, way: f64) -> bool {
        let Point { configuration, tangent, .. } = point;
        // where the pose hardly moves, a small step of the branch is small enough
        let distance = (way / tangent.by_tau()).min(FARTHEST_PROBE);
        let mut probe = tangent.ahead(configuration, distance);
        let plane = Condition::Plane { tangent, from: &configuration.z, distance };
        if !self.corrector.correct(&mut probe, plane).status.is_solved() {
            return false;
        }
        let scan = self.scan(&probe);
        let mut holds = true;
        breaks(&self.corrector.setup.world, &probe, &scan.crossings, |_| holds = false);
        if probe.rubs() {
            let there = self.corrector.inspect(&probe, plane).0;
            holds &= reversed(&self.corrector.setup.world, &probe, &there).next().is_none();
        }
        holds && self.is_stable(&probe, &scan)
    }
}

/// Whether tau falls somewhere within a step although it grows at both ends, as the cubic of the step tells: there are two folds on the
/// way. One alone shows in the slope at the end.
fn turns_twice(from: &Point, next: &Configuration, after: &Tangent, length: f64) -> bool {
    let chord = (next.tau() - from.configuration.tau()) / length;
    let stretch = from.tangent.component(&after.direction);
    let (first, last) = (from.tangent.by_tau(), after.by_tau() / stretch);
    // next to buckling tau hardly changes at all, and falls by rounding
    last > 0.0 && least_rate([first, last], chord).is_some_and(|least| least < -STEEPEST)
}

/// Whether the last contact, which is at s = 1, is about to leave the rod.
fn runs_off(Point { configuration, tangent, .. }: &Point) -> bool {
    configuration.count().checked_sub(1).is_some_and(|j| {
        !configuration.is_tip(j) && configuration.s(j) > 1.0 - AT_ONCE && tangent.rate_of(Unknown::ArcLength(j)) > 0.0
    })
}

fn ordered_or_new(configuration: &Configuration) -> bool {
    let n = configuration.count();
    (1..n).all(|j| configuration.s(j) >= configuration.s(j - 1))
}
