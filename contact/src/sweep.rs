//! The sweep: the clamp goes along its path, and every phase and transition is found.

use crate::contact_set::edit::{across_corner, beside_corner, beyond_corner, off_corner};
use crate::contact_set::{Configuration, Held};
use crate::continuation::branch::Corrector;
use crate::continuation::certify::{Quality, state};
use crate::continuation::inflection::is_at_inflection;
use crate::continuation::step::{Change, FIRST_STEP, Point, SAME_POSE, Seen, Step, Stepper};
use crate::error::{ContactError, Stop, StopReason};
use crate::event::{Event, EventKind};
use crate::gap::GAP_TOLERANCE;
use crate::gap::scan::{Scan, Scanner};
use crate::path::ClampPath;
use crate::scene::setup::Setup;
use crate::snap::chain::Chain;
use crate::snap::settle::settle;
use crate::state::State;
use rod_contours::Composite;
use rod_core::{Pose, Rod};
use std::collections::VecDeque;
use std::f64::consts::PI;

/// What a sweep comes to next.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Item {
    /// The equilibrium at a pose that is reported.
    State(State),
    /// A transition.
    Event(Event),
}

/// All of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Outcome {
    /// States at start, start + step, ...
    pub states: Vec<State>,
    /// Transitions in order.
    pub events: Vec<Event>,
    /// Why it stopped before the end of the path, if it did.
    pub stop: Option<Stop>,
}

/// A sweep of a rod past a contour: an iterator of states and events in the order in which they come. After an `Err` it is
/// over; all items before stand.
#[derive(Debug)]
pub struct Sweep<'a> {
    stepper: Stepper<'a>,
    /// Distance of reported states, dimensionless.
    step: f64,
    /// Number of states to report, and how many have been.
    reports: usize,
    reported: usize,
    at: Option<Box<Point>>,
    /// The step from there, while poses on it are reported.
    ahead: Option<Step>,
    pending: VecDeque<Item>,
    over: bool,
    /// Path parameter of the last state, or of a snap without landing: how far it came.
    reached: f64,
    /// Where the last transition was, and how many there were at that pose.
    crowd: (f64, usize),
}

/// Largest number of reported states. With more, neighbouring poses differ by less than the rounding of the path parameter.
const MOST_STEPS: f64 = 1e15;

/// Default limit of steps along branches, rejected ones included: one to two minutes. A sweep of the paper takes about 50.
const MOST_STEPS_TAKEN: u64 = 2_000_000;

/// Largest number of transitions at one pose. A rod that comes to lie on the edges of a comb needs several; more are a contact
/// that comes and goes by rounding.
const MOST_AT_ONE_POSE: usize = 12;
/// Distance (L) from an end of an open contour. Where contacts come and go closer to it, the sweep stops with `EndOfContour`,
/// farther away with `Chatter`.
const AT_OPEN_END: f64 = 1e-3;
/// Distances (path parameter) beyond a fold at which the descent starts, tried in order. The chain has its own fold, up to the
/// square of a link's length away, and must be beyond it. A longer distance may miss an equilibrium that ends soon.
const KICK: [f64; 4] = [2e-3, 8e-3, 2e-2, 5e-2];
/// The same beyond the first touch of a free rod along a straight edge, which has no isolated solution.
const TOUCH_KICK: [f64; 2] = [1e-4, 5e-4];
/// Bends (rad over the length) given to a straight rod that is let go into contact, tried in order. Without a bend the chain
/// does not buckle; its sign decides to which side.
const BENDS: [f64; 4] = [0.05, -0.05, 0.5, -0.5];
/// Longest and shortest way (L) of a tip that slips over a corner. A longer way is reported as a snap; a shorter one would lead
/// back at once.
const FARTHEST_SLIP: f64 = 0.05;
const SHORTEST_SLIP: f64 = 1e-9;
/// Range and step of the search for a free pose behind a start in contact, in the path parameter: lengths of the rod, or
/// radians of a path that only turns.
const BACK: (f64, f64) = (4.0, 0.05);

impl<'a> Sweep<'a> {
    /// A sweep of `rod` along `path` past `objects` (m): one [`Composite`], or a list of them. States are reported at 0,
    /// `step`, 2 `step`, ... of the path's parameter (m, or radians where the clamp only turns).
    ///
    /// A start in contact has the shape that a sweep from further back along the same line would have brought there.
    /// Where there is none, it is one that the clamp turned, or moved sideways, into its first pose would have brought;
    /// and where there is none either, the straight rod is let go into contact.
    ///
    /// # Errors
    /// [`ContactError::Step`].
    pub fn new(
        rod: &Rod,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        path: ClampPath,
        step: f64,
    ) -> Result<Self, ContactError> {
        let wrong = ContactError::Step { value: step };
        if !(step.is_finite() && step > 0.0) {
            return Err(wrong);
        }
        let step = if path.turns_only() { step } else { step / rod.length() };
        let setup = Setup::new(rod, objects.as_ref(), path);
        // a path that is a whole number of steps long but for rounding reports its end
        let steps = (setup.path.length() / step * (1.0 + 1e-12)).floor();
        if steps > MOST_STEPS {
            return Err(wrong);
        }
        Ok(Self::from_setup(setup, MOST_STEPS_TAKEN, step, steps as usize + 1))
    }

    fn from_setup(setup: Setup<'a>, steps_left: u64, step: f64, reports: usize) -> Self {
        Self {
            stepper: Stepper::new(Corrector::new(setup), steps_left),
            step,
            reports,
            reported: 0,
            at: None,
            ahead: None,
            pending: VecDeque::new(),
            over: false,
            reached: 0.0,
            crowd: (f64::NAN, 0),
        }
    }

    fn setup(&self) -> &Setup<'a> {
        &self.stepper.corrector.setup
    }

    /// Ends with [`StopReason::StepBudget`] after so many steps along branches of equilibria, those counted that were tried and
    /// found too long; by default after 2 million, which takes a minute or two. An event takes about ten.
    #[must_use]
    pub fn with_most_steps(mut self, most: u64) -> Self {
        self.stepper.steps_left = most;
        self
    }

    /// Runs to the end and keeps everything.
    pub fn run(self) -> Outcome {
        let mut outcome = Outcome::default();
        for item in self {
            match item {
                Ok(Item::State(state)) => outcome.states.push(state),
                Ok(Item::Event(event)) => outcome.events.push(event),
                Err(stop) => outcome.stop = Some(stop),
            }
        }
        outcome
    }

    /// Goes on until there is something to hand out. The branch is followed by steps of its own; the poses to report lie on
    /// them and have no part in where a step ends.
    fn advance(&mut self) -> Result<(), StopReason> {
        let Some(point) = self.at.take() else {
            let start = Box::new(self.start()?);
            self.report(&start);
            self.at = Some(start);
            return Ok(());
        };
        // a snap may have jumped over a pose: there is no equilibrium to report there
        while self.pose() < point.configuration.tau() - SAME_POSE && self.reported < self.reports {
            self.reported += 1;
        }
        let (end, pose) = (self.setup().path.length(), self.pose());
        if self.reported < self.reports && pose <= point.configuration.tau() + SAME_POSE {
            self.report(&point);
            self.at = Some(point);
            return Ok(());
        }
        if point.configuration.tau() >= end - SAME_POSE {
            self.over = true;
            return Ok(());
        }
        let ahead = match self.ahead.take() {
            Some(step) => Ok(step),
            None => self.stepper.step(&point, end),
        };
        let next = match ahead {
            Ok(step) if self.reported < self.reports && pose < step.tau() + step.rounding() => {
                if let Some(state) = self.stepper.between(&point, &step, pose) {
                    self.report(&state);
                    (self.at, self.ahead) = (Some(point), Some(step));
                    return Ok(());
                }
                if pose < step.tau() {
                    // the step has passed over something
                    self.stepper.step(&point, pose).and_then(|step| self.arrive(step))
                } else {
                    self.arrive(step)
                }
            }
            ahead => ahead.and_then(|step| self.arrive(step)),
        };
        match next {
            Ok(next) => self.at = Some(next),
            Err(reason) => {
                // kept for the message
                self.at = Some(point);
                return Err(reason);
            }
        }
        Ok(())
    }

    /// The next pose to report; the last one may be beyond the end by rounding.
    fn pose(&self) -> f64 {
        (self.step * self.reported as f64).min(self.setup().path.length())
    }

    /// Where a step leads, with the transition that ends it.
    fn arrive(&mut self, step: Step) -> Result<Box<Point>, StopReason> {
        match step {
            Step::Moved(next) => Ok(next),
            Step::Changed(change) => {
                let Change { kind, before, after } = *change;
                self.count_crowd(&after.configuration)?;
                // a corner at the very tip is none
                let beside = beside_corner(&after.configuration, &self.setup().world);
                self.stepper.h = FIRST_STEP;
                let before = self.stepper.look(before);
                match self.goes_on(after).or_else(|| beside.into_iter().find_map(|beside| self.goes_on_as(beside))) {
                    Some(after) => {
                        let before = self.stepper.point(before);
                        self.announce(kind, &before, &after);
                        Ok(Box::new(after))
                    }
                    None => self.snap(before).map(Box::new),
                }
            }
            Step::Ended(last) => {
                self.count_crowd(&last.configuration)?;
                self.snap(*last).map(Box::new)
            }
        }
    }

    /// The point of a new contact set, if the sweep can go on with it.
    fn goes_on(&mut self, seen: Seen) -> Option<Point> {
        let point = self.stepper.point(seen);
        self.stepper.goes_on(&point).then_some(point)
    }

    fn goes_on_as(&mut self, configuration: Configuration) -> Option<Point> {
        let seen = self.stepper.look(configuration);
        self.goes_on(seen)
    }

    fn count_crowd(&mut self, reached: &Configuration) -> Result<(), StopReason> {
        let tau = reached.tau();
        self.crowd = if (tau - self.crowd.0).abs() < 1e-9 { (tau, self.crowd.1 + 1) } else { (tau, 0) };
        if self.crowd.1 <= MOST_AT_ONE_POSE {
            return Ok(());
        }
        // an open contour that is met head-on at its end has no side to rest on
        let world = &self.setup().world;
        let at_end = |(held, j): (&Held, usize)| {
            let at = world.support(held.stretch, reached.t(j));
            world.open_ends().iter().any(|(x, y)| (at.x - x).hypot(at.y - y) < AT_OPEN_END)
        };
        let by_an_end = reached.contacts.iter().zip(0..).any(at_end);
        Err(if by_an_end { StopReason::EndOfContour } else { StopReason::Chatter })
    }

    /// The equilibrium ends in `last`: the rod jumps to where the descent of its energy leads.
    fn snap(&mut self, last: Seen) -> Result<Point, StopReason> {
        let (here, tau) = (&last.configuration, last.configuration.tau());
        if let Some(landed) = self.slip(here) {
            return Ok(self.landed(EventKind::Slip, last, landed));
        }
        let mut beyond = None;
        // a free rod has no fold to get over
        let kicks = TOUCH_KICK.into_iter().filter(|_| here.count() == 0).chain(KICK);
        for kick in kicks {
            // from inside an object the descent leads anywhere
            if self.is_clamp_inside(tau + kick) {
                continue;
            }
            let Landed { at_pose, ahead } = self.land(here, tau, kick);
            // a free rod that touches something and stays free has gone past it
            let elsewhere = |landed: &Seen| here.count() + landed.configuration.count() > 0;
            // one that does not hold further on would only lead back
            if let Some(landed) = at_pose.filter(elsewhere).and_then(|landed| self.goes_on(landed)) {
                return Ok(self.jumped(last, landed));
            }
            beyond = beyond.or(ahead.filter(elsewhere));
        }
        // Where the new branch starts only just beyond the fold, it is entered there. And a rod that does not come to
        // rest in the descent, but could be free, will be.
        let landed = beyond.or_else(|| self.free(tau).filter(|_| here.count() > 0).map(|free| self.stepper.look(free)));
        if let Some(landed) = landed {
            let landed = self.stepper.point(landed);
            return Ok(self.jumped(last, landed));
        }
        if let Some(landed) = self.slip_off(here) {
            return Ok(self.landed(EventKind::Slip, last, landed));
        }
        if let Some(landed) = self.slide_over(here) {
            return Ok(self.jumped(last, landed));
        }
        self.reached = tau;
        Err(if is_at_inflection(&self.setup().world, here) {
            StopReason::LineContact
        } else if last.scan.is_by_an_end() {
            StopReason::EndOfContour
        } else {
            StopReason::NoLanding
        })
    }

    /// A point with everything known of it.
    fn at_rest(&mut self, configuration: Configuration) -> Point {
        let seen = self.stepper.look(configuration);
        self.stepper.point(seen)
    }

    /// The tip, come to a convex corner, slips over it and rests on the piece beyond: where the turn is small a short jump,
    /// which needs no descent to find.
    fn slip(&mut self, last: &Configuration) -> Option<Point> {
        let guess = beyond_corner(last.clone(), &self.setup().world)?;
        self.slipped(last, guess)
    }

    /// A corner slips off the tip, which rests on a piece beside it: where the descent, whose links are longer than such a slip,
    /// comes to no rest.
    fn slip_off(&mut self, last: &Configuration) -> Option<Point> {
        off_corner(last, &self.setup().world).into_iter().find_map(|guess| self.slipped(last, guess))
    }

    /// The tip, come to a convex corner, slides over it until the rod lies on the corner: where the descent comes to no rest.
    fn slide_over(&mut self, last: &Configuration) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let guess = across_corner(last.clone(), &corrector.setup.world)?;
        let landed = settle(corrector, scanner, guess).filter(|landed| !same(&landed.configuration, last))?;
        self.goes_on(landed)
    }

    /// The equilibrium by `guess`, if it is a slip away from `last`.
    fn slipped(&mut self, last: &Configuration, guess: Configuration) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let here = last.contacts.last()?.stretch;
        let landed = settle(corrector, scanner, guess)?;
        let Seen { configuration, .. } = &landed;
        let n = configuration.count();
        let tip = n.checked_sub(1).filter(|_| configuration.ends_at_tip() && n == last.count())?;
        let (world, there) = (&corrector.setup.world, configuration.contacts[tip].stretch);
        let from = world.support(here, last.t(last.count() - 1));
        let to = world.support(there, configuration.t(tip));
        // no way at all would be back at once
        let way = (to.x - from.x).hypot(to.y - from.y);
        let slips = there != here && (SHORTEST_SLIP..FARTHEST_SLIP).contains(&way);
        slips.then(|| self.stepper.point(landed))
    }

    /// Whether the clamp is inside an object at `tau`.
    fn is_clamp_inside(&self, tau: f64) -> bool {
        let Setup { world, path, .. } = self.setup();
        let Pose { x, y, .. } = path.at(tau);
        let mut inside = false;
        world.objects_at(x, y, |object| inside |= world.is_inside(object, x, y, GAP_TOLERANCE));
        inside
    }

    fn jumped(&mut self, last: Seen, landed: Point) -> Point {
        let kind = match (last.configuration.count(), landed.configuration.count()) {
            (0, _) => EventKind::FirstContact,
            (_, 0) => EventKind::SnapOff,
            _ => EventKind::Snap,
        };
        self.landed(kind, last, landed)
    }

    fn landed(&mut self, kind: EventKind, last: Seen, landed: Point) -> Point {
        let before = self.stepper.point(last);
        self.announce(kind, &before, &landed);
        self.stepper.h = FIRST_STEP;
        landed
    }

    /// Where the rod lands from `last`, whose clamp is at `tau`: found `kick` beyond, and brought back to `tau` if it
    /// can be.
    fn land(&mut self, last: &Configuration, tau: f64, kick: f64) -> Landed {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let clamp = corrector.setup.path.at(tau + kick);
        let mut chain = Chain::of(&corrector.setup, last, clamp);
        // head-on, a straight rod gives to either side
        chain.bend_if_straight(BENDS[0]);
        let ahead = rest(&mut chain, corrector, scanner, tau + kick, |_| true);
        let elsewhere = |found: &Seen| !same(&found.configuration, last);
        let back = ahead.as_ref().and_then(|ahead| {
            let mut back = ahead.configuration.clone();
            back.set_tau(tau);
            settle(corrector, scanner, back).filter(elsewhere)
        });
        let at_pose = back.or_else(|| {
            chain.clamp = corrector.setup.path.at(tau);
            rest(&mut chain, corrector, scanner, tau, elsewhere)
        });
        Landed { at_pose, ahead }
    }

    /// The first point: free, or brought into contact along the path, or else by another way.
    fn start(&mut self) -> Result<Point, StopReason> {
        if let Some(start) = self.free(0.0) {
            return Ok(self.at_rest(start));
        }
        if self.scan_straight(0.0).clamp_inside {
            return Err(StopReason::ClampInside);
        }
        let own = self.setup().path;
        let ways = std::iter::once(own).chain(own.others_to_its_start());
        let brought = ways.into_iter().find_map(|way| self.brought_by(way));
        let brought = brought.map(|start| self.stepper.look(start));
        let start = brought.or_else(|| self.let_go()).ok_or(StopReason::NoStart)?;
        let start = self.stepper.point(start);
        if start.scan.is_outside() { Ok(start) } else { Err(StopReason::NoStart) }
    }

    /// The rod in the first pose, come there on a path that goes through that pose at 0: swept in silence from where,
    /// further back, it is free.
    fn brought_by(&mut self, way: ClampPath) -> Option<Configuration> {
        let farthest = if way.turns_only() { PI } else { BACK.0 };
        let tries = (farthest / BACK.1) as usize;
        let mut silent = Self::from_setup(self.setup().along(way), self.stepper.steps_left, f64::INFINITY, 0);
        let start = (1..=tries).find_map(|k| silent.free(-BACK.1 * k as f64))?;
        let mut point = Box::new(silent.at_rest(start));
        let brought = loop {
            if point.configuration.tau() >= 0.0 {
                break Some(point.configuration);
            }
            match silent.stepper.step(&point, 0.0).and_then(|step| silent.arrive(step)) {
                Ok(next) => point = next,
                Err(_) => break None,
            }
            silent.pending.clear();
        };
        self.stepper.steps_left = silent.stepper.steps_left;
        brought
    }

    /// The straight rod at a pose, if it touches nothing there.
    fn free(&mut self, tau: f64) -> Option<Configuration> {
        let scan = self.scan_straight(tau);
        scan.is_outside().then(|| Configuration::free(tau))
    }

    /// A look at the straight rod where it has not come from elsewhere: all that is behind an open contour is solid.
    fn scan_straight(&mut self, tau: f64) -> Scan {
        let filled = self.setup().filled();
        self.stepper.scanner.scan(&filled, &Configuration::free(tau))
    }

    /// The straight rod let go in the first pose.
    fn let_go(&mut self) -> Option<Seen> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        BENDS.into_iter().find_map(|bend| {
            rest(&mut Chain::straight(corrector.setup.path.at(0.0), bend), corrector, scanner, 0.0, |_| true)
        })
    }

    fn report(&mut self, point: &Point) {
        self.reached = self.reached.max(point.configuration.tau());
        self.pending.push_back(Item::State(self.state(point)));
        self.reported += 1;
    }

    fn announce(&mut self, kind: EventKind, before: &Point, after: &Point) {
        let event = Event { kind, before: self.state(before), after: self.state(after) };
        self.pending.push_back(Item::Event(event));
    }

    fn state(&self, point: &Point) -> State {
        let free = point.configuration.count() == 0;
        let quality = if free { Quality::FREE } else { point.quality };
        state(self.setup(), &point.configuration, &point.scan, quality)
    }

    fn stop(&self, reason: StopReason) -> Stop {
        let Setup { rod, path, .. } = self.setup();
        let tau = self.at.as_ref().map_or(0.0, |point| point.configuration.tau()).max(self.reached);
        let length = rod.length();
        let Pose { x, y, phi } = path.at(tau);
        let unit = if path.turns_only() { 1.0 } else { length };
        Stop { pose: Pose { x: x * length, y: y * length, phi }, tau: tau * unit, reason }
    }
}

/// Where a rod lands: at the pose where its equilibrium ended, and a little further along the path.
struct Landed {
    at_pose: Option<Seen>,
    ahead: Option<Seen>,
}

/// The first acceptable equilibrium of those where the chain comes to rest, with its clamp at `tau`.
fn rest(
    chain: &mut Chain,
    corrector: &mut Corrector<'_>,
    scanner: &mut Scanner,
    tau: f64,
    accept: impl Fn(&Seen) -> bool,
) -> Option<Seen> {
    let guesses = chain.settle(&corrector.setup.world, tau);
    guesses.into_iter().find_map(|guess| settle(corrector, scanner, guess).filter(&accept))
}

/// Whether two configurations at one pose are the same equilibrium.
fn same(a: &Configuration, b: &Configuration) -> bool {
    a.contacts == b.contacts && a.z.iter().zip(&b.z).all(|(u, v)| (u - v).abs() < 1e-4 * (1.0 + v.abs()))
}

impl Iterator for Sweep<'_> {
    type Item = Result<Item, Stop>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(item) = self.pending.pop_front() {
                return Some(Ok(item));
            }
            if self.over {
                return None;
            }
            if let Err(reason) = self.advance() {
                self.over = true;
                return Some(Err(self.stop(reason)));
            }
        }
    }
}
