//! The sweep: the clamp goes along its path, and every phase and transition is found.

mod advance;
mod begin;
mod bistable;
mod follower;
mod landing;
mod leg;
mod outcome;
mod report;
mod resume;
mod rubbing;

pub use follower::Follower;
pub use outcome::{Approach, Item, Outcome, Start, StartCandidate};

use crate::continuation::branch::Corrector;
use crate::continuation::stepper::Stepper;
use crate::continuation::{Point, Step};
use crate::error::{ContactError, Stop};
use crate::friction::Friction;
use crate::limits::LIMITS;
use crate::path::Path;
use crate::scene::Setup;
use crate::scene::way::Way;
use crate::state::State;
use advance::Crowd;
use leg::{Course, Leg, legs};
use resume::Departure;
use rod_contours::Composite;
use rod_core::{PhysicalRod, Rod};
use std::collections::VecDeque;

/// A sweep of a rod past a contour: an iterator of states and events in the order in which they come. After an `Err` it is
/// over; all items before stand.
#[derive(Debug)]
pub struct Sweep<'a, R = Rod> {
    stepper: Stepper<'a, R>,
    stage: Stage,
    course: Course,
    /// How the first equilibrium was found, once it is.
    start: Option<Start>,
    /// What is found and not yet handed out.
    pending: VecDeque<Item>,
    /// Whether it only brings an equilibrium to another pose.
    is_silent: bool,
    /// Whether it ends where the rod jumps.
    ends_at_jump: bool,
    /// Path parameter of the last state, or of a snap without landing: how far it came.
    reached: f64,
    crowd: Crowd,
    /// Energy (E I / L) that friction and jumps have taken so far; none where a point on the way was not found.
    dissipated: Option<f64>,
}

/// Where a sweep is.
#[derive(Debug)]
enum Stage {
    /// Before the first point of a leg, which begins with an equilibrium that is given, or that is looked for.
    Begins(Option<Box<Departure>>),
    /// At a point of a branch; with the step from there, while poses on it are reported.
    At(Box<Point>, Option<Step>),
    /// At its end, and at the last point, if there was one.
    Over(Option<Box<Point>>),
}

impl<'a, R: PhysicalRod> Sweep<'a, R> {
    /// A sweep of `rod` along `path` past `objects` (m): one [`Composite`], or a list of them. States are reported at 0,
    /// `step`, 2 `step`, ... of the path's parameter (of a [`ClampPath`](crate::ClampPath) m, or radians where the clamp only
    /// turns), and at its end. On a [`Chain`](crate::Chain) of paths each leg counts from its own start.
    ///
    /// A start in contact has the shape that a sweep from at most two lengths (or radians) further back along the same line would have
    /// brought there. Where there is none, it takes, of the equilibria that the rod comes to when its clamp moves along the path's
    /// line, turns, or moves sideways into the first pose, and when it is let go there, the one of least energy; [`start`](Self::start) and
    /// [`Outcome::start`] tell which and what others there were.
    ///
    /// # Errors
    /// [`ContactError::Step`]; of a path of one's own also [`ContactError::NotFinite`], [`ContactError::Angle`],
    /// [`ContactError::NoPath`], [`ContactError::Rate`].
    pub fn new(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        path: impl Path + 'static,
        step: f64,
    ) -> Result<Self, ContactError> {
        Self::along(rod, objects.as_ref(), legs(path, rod.units())?, |_| step)
    }

    /// A sweep that goes on from `state`, an equilibrium of `rod` on `objects` (of an earlier sweep, an event, or
    /// [`equilibrium`](crate::equilibrium)): with its contacts, the side on which each lies and the turns of a coil, in
    /// any direction. The first pose of `path` is the state's, to 1e-9 of the rod's length; there the state is reported again.
    ///
    /// An equilibrium that cannot be followed that way, such as the one before a snap, is left at once, as in a sweep.
    ///
    /// ```
    /// use rod_contact::{ClampPath, Sweep};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
    /// let there = Sweep::new(&rod, &object, ClampPath::new(clamp(0.5), clamp(0.1))?, 0.1)?.run().states;
    /// let back = ClampPath::new(clamp(0.1), clamp(0.5))?;
    /// let back = Sweep::from_state(&rod, &object, &there[4], back, 0.1)?.run().states;
    /// for (back, there) in back.iter().zip(there.iter().rev()) {
    ///     assert!((back.reactions.f0x - there.reactions.f0x).abs() < 1e-9);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Step`]; [`ContactError::Elsewhere`] where the path begins at another pose; [`ContactError::Guess`] and
    /// [`ContactError::NotEquilibrium`] where the state is none of this rod on these objects.
    pub fn from_state(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        state: &State,
        path: impl Path + 'static,
        step: f64,
    ) -> Result<Self, ContactError> {
        let (first, pose) = (path.point(0.0).pose, state.pose);
        let off = (first.x - pose.x).hypot(first.y - pose.y) / rod.units().length + (first.phi - pose.phi).abs();
        if off.is_nan() || off > LIMITS.resume.same_pose {
            return Err(ContactError::Elsewhere { path: first, state: pose });
        }
        let mut sweep = Self::along(rod, objects.as_ref(), legs(path, rod.units())?, |_| step)?;
        sweep.stage = Stage::Begins(Some(Box::new(sweep.recall_state(state)?.into())));
        sweep.start = Some(Start::Given);
        Ok(sweep)
    }

    /// [`new`](Self::new) with a step for each leg of the path, in the unit of that leg's parameter.
    ///
    /// # Errors
    /// As [`new`](Self::new); [`ContactError::Steps`] where there are not as many steps as legs.
    pub fn with_steps(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        path: impl Path + 'static,
        steps: &[f64],
    ) -> Result<Self, ContactError> {
        let ways = legs(path, rod.units())?;
        if ways.len() != steps.len() {
            return Err(ContactError::Steps { steps: steps.len(), legs: ways.len() });
        }
        Self::along(rod, objects.as_ref(), ways, |leg| steps[leg])
    }

    /// The sweep along such legs.
    fn along(
        rod: &R,
        objects: &'a [Composite],
        ways: Vec<Way>,
        step: impl Fn(usize) -> f64,
    ) -> Result<Self, ContactError> {
        let leg = |(number, way)| Leg::new(way, step(number), rod.units().length);
        let mut legs = ways.into_iter().enumerate().map(leg).collect::<Result<VecDeque<_>, _>>()?;
        let Leg { way, step, reports } = legs.pop_front().ok_or(ContactError::NoLegs)?;
        let sweep = Self::from_setup(Setup::on(rod, objects, way), LIMITS.sweep.most_steps, step, reports);
        Ok(Self { course: sweep.course.followed_by(legs), ..sweep })
    }

    fn from_setup(setup: Setup<'a, R>, steps_left: u64, step: f64, reports: usize) -> Self {
        Self {
            stepper: Stepper::new(Corrector::new(setup), steps_left),
            stage: Stage::Begins(None),
            course: Course::single(step, reports),
            start: None,
            pending: VecDeque::new(),
            is_silent: false,
            ends_at_jump: false,
            reached: 0.0,
            crowd: Crowd::NONE,
            dissipated: Some(0.0),
        }
    }

    /// Sets out anew on another path (dimensionless), from an equilibrium at its first pose.
    fn set_out(&mut self, path: Way, mut from: Departure) {
        from.configuration.set_tau(0.0);
        self.stepper.corrector.setup.path = path;
        self.stepper.h = LIMITS.step.first;
        self.stage = Stage::Begins(Some(Box::new(from)));
        self.pending.clear();
        (self.reached, self.crowd) = (0.0, Crowd::NONE);
    }

    fn setup(&self) -> &Setup<'a, R> {
        &self.stepper.corrector.setup
    }

    /// Ends with [`StopReason::StepBudget`](crate::StopReason::StepBudget) after so many steps along branches of equilibria, those counted that were tried and
    /// found too long; by default after 2 million, which takes a minute or two. An event takes about ten.
    #[must_use]
    pub fn with_most_steps(mut self, most: u64) -> Self {
        self.stepper.steps_left = most;
        self
    }

    /// How the first equilibrium was found: none before the first item, or where there is none.
    pub fn start(&self) -> Option<&Start> {
        self.start.as_ref()
    }

    /// Gives the objects friction: a coefficient, one for each object, or a law ([`Friction`]).
    ///
    /// Contacts then slip, stick or roll (Coulomb's law), which [`Contact::friction`](crate::Contact::friction) tells. The modes are chosen
    /// anew at every event, and where the path turns, by the motion that they allow. Where the rod has snapped its friction is an estimate: the
    /// descent that finds where it lands knows no friction, and each contact is held back in the sense in which it came. A start in contact goes on from
    /// the forces that it has as it was brought there, and, where it was let go there, without a force along the contour.
    ///
    /// ```
    /// use rod_contact::{ClampPath, SlipMode, Sweep};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
    /// let path = ClampPath::new(clamp(0.5), clamp(0.1))?;
    /// let state = Sweep::new(&rod, &object, path, 0.1)?.with_friction(0.3)?.run().states.pop().ok_or("no state")?;
    /// let (contact, friction) = (&state.contacts[0], state.contacts[0].friction.ok_or("no friction")?);
    /// // the clamp moves to the left, and draws the rod back along the contour
    /// assert_eq!(friction.mode, SlipMode::Backward);
    /// assert!((friction.force - 0.3 * contact.force).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Friction`] where a coefficient is negative or not finite, where a static one is below the kinetic one, and where a list
    /// is longer than that of the objects.
    pub fn with_friction(mut self, friction: impl Friction) -> Result<Self, ContactError> {
        self.stepper.corrector.setup.world.rub(&friction)?;
        Ok(self)
    }

    /// The energy (J) that is lost so far: the work of friction, the integral of |f_t dg| over all contacts that slip, and at each jump, where
    /// the clamp does no work, the energy before less that after. A rod jumps where its equilibrium ends (`snap`, `snap-off`, `slip-over`),
    /// and where a contact begins to slip whose kinetic coefficient is below the static one. None without friction, and where it is not known.
    ///
    /// The clamp's work is the change of the energy of rod and clamp plus this, within 1e-12 E I / L for each of the
    /// phases of a scan of the paper, but for the last step before a fold.
    pub fn dissipated(&self) -> Option<f64> {
        let energy = self.setup().rod.units().energy;
        self.dissipated.filter(|_| self.setup().world.rubs()).map(|work| work * energy)
    }

    /// Runs to the end and keeps everything.
    pub fn run(mut self) -> Outcome {
        let mut outcome = Outcome::default();
        for item in &mut self {
            match item {
                Ok(Item::State(state)) => outcome.states.push(state),
                Ok(Item::Event(event)) => outcome.events.push(event),
                Err(stop) => outcome.stop = Some(stop),
            }
        }
        outcome.dissipated = self.dissipated();
        outcome.start = self.start;
        outcome
    }
}

impl<R: PhysicalRod> Iterator for Sweep<'_, R> {
    type Item = Result<Item, Stop>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(item) = self.pending.pop_front() {
                return Some(Ok(item));
            }
            if matches!(self.stage, Stage::Over(_)) {
                return None;
            }
            if let Err(reason) = self.advance() {
                return Some(Err(self.stop(reason)));
            }
        }
    }
}
