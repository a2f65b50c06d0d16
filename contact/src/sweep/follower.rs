//! A rod that is moved step by step, from one equilibrium to the next.

use super::leg::Course;
use super::resume::Departure;
use super::{Item, Stage, Sweep};
use crate::continuation::Point;
use crate::error::{ContactError, Stop, StopReason};
use crate::friction::Friction;
use crate::friction::sliding::sliding_near;
use crate::limits::LIMITS;
use crate::path::{ClampPath, check};
use crate::scene::Setup;
use crate::state::State;
use rod_contours::Composite;
use rod_core::{PhysicalRod, Pose, Rod};

/// A rod in equilibrium whose clamp is moved from pose to pose: for controllers, which decide where to go next by what the clamp
/// feels now. Each move follows the branch of equilibria through all its transitions, as a [`Sweep`] does.
///
/// A clone goes its own way: to try a move, make it with a clone.
///
/// ```
/// use rod_contact::{Follower, Item};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
/// let clamp = |x, y| Pose { x, y, phi: std::f64::consts::FRAC_PI_2 };
/// let mut rod = Follower::new(&rod, &object, clamp(0.5, -0.4))?;
/// let items = rod.to(clamp(0.2, -0.4))?;
/// let phases: Vec<_> = items.iter().filter_map(|item| match item {
///     Item::Event(event) => Some(event.to().to_string()),
///     Item::State(_) => None,
/// }).collect();
/// assert_eq!(phases, ["A"]);
/// let mut tried = rod.clone();
/// tried.to(clamp(0.2, -0.3))?;
/// assert!(tried.state().reactions.f0x.abs() > rod.state().reactions.f0x.abs());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Follower<'a, R = Rod> {
    sweep: Sweep<'a, R>,
    at: Box<Point>,
    /// The clamp, dimensionless.
    pose: Pose,
    state: State,
    most_steps: u64,
}

impl<'a, R: PhysicalRod> Follower<'a, R> {
    /// A rod with its clamp at `pose` (m, radians). Where it is in contact there, it has the shape that it gets when it is
    /// pushed forward along its own axis, or another one that [`Sweep::new`] describes.
    ///
    /// # Errors
    /// [`Stop`] with [`StopReason::NoPose`], [`StopReason::ClampInside`] or [`StopReason::NoStart`].
    pub fn new(rod: &R, objects: &'a (impl AsRef<[Composite]> + ?Sized), pose: Pose) -> Result<Self, Stop> {
        if check(pose, ["x", "y", "phi"]).is_err() {
            return Err(Stop { pose, tau: 0.0, reason: StopReason::NoPose });
        }
        let (sin, cos) = pose.phi.sin_cos();
        let length = rod.units().length;
        let ahead = Pose { x: pose.x + length * cos, y: pose.y + length * sin, ..pose };
        let Ok(path) = ClampPath::new(pose, ahead) else {
            return Err(Stop { pose, tau: 0.0, reason: StopReason::NoPose });
        };
        let mut sweep = Sweep::from_setup(Setup::new(rod, objects.as_ref(), path), LIMITS.sweep.most_steps, 1.0, 0);
        match sweep.find_start() {
            Ok((at, _)) => Ok(Self::at_rest(sweep, at)),
            Err(reason) => Err(Stop { pose, tau: 0.0, reason }),
        }
    }

    /// A rod in an equilibrium that is known: a state of `rod` on `objects` from a sweep, an event or
    /// [`equilibrium`](crate::equilibrium).
    ///
    /// # Errors
    /// [`ContactError::NotFinite`], [`ContactError::Angle`]; [`ContactError::Guess`] and [`ContactError::NotEquilibrium`] where
    /// the state is none of this rod on these objects.
    pub fn from_state(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        state: &State,
    ) -> Result<Self, ContactError> {
        check(state.pose, ["state.pose.x", "state.pose.y", "state.pose.phi"])?;
        let setup = Setup::new(rod, objects.as_ref(), ClampPath::standing(state.pose));
        let mut sweep = Sweep::from_setup(setup, LIMITS.sweep.most_steps, 1.0, 0);
        let recalled = sweep.recall_state(state)?;
        let at = sweep.point_of(recalled);
        Ok(Self::at_rest(sweep, at))
    }

    /// Gives the objects friction, as [`Sweep::with_friction`] does: of a rod that is free, or in an equilibrium with friction that was
    /// given to [`from_state`](Self::from_state). One that [`new`](Self::new) has found in contact knows no friction: its contacts begin at the
    /// next move as those of a rod that was laid there, without a force along the contour.
    ///
    /// ```
    /// use rod_contact::{Follower, SlipMode};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
    /// let mut rod = Follower::new(&rod, &object, clamp(0.9))?.with_friction(0.3)?;
    /// let mode = |rod: &Follower<'_>| rod.state().contacts[0].friction.map(|friction| friction.mode);
    /// rod.to(clamp(0.2))?;
    /// assert_eq!(mode(&rod), Some(SlipMode::Backward));
    /// // it turns back, and the rod rolls on the object before it slips the other way
    /// rod.to(clamp(0.2001))?;
    /// assert_eq!(mode(&rod), Some(SlipMode::Stick));
    /// rod.to(clamp(0.25))?;
    /// assert_eq!(mode(&rod), Some(SlipMode::Forward));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Friction`].
    pub fn with_friction(mut self, friction: impl Friction) -> Result<Self, ContactError> {
        self.sweep = self.sweep.with_friction(friction)?;
        Ok(self)
    }

    /// Lets all contacts slide the same way along the rod, whatever their motion: of each the force is turned from the normal of the contour by
    /// atan `coefficient`, towards the tip of the rod where that is positive, as on a rod that is drawn back over its contacts. Unlike with
    /// [friction](Self::with_friction) a state does not depend on how the rod came there, so that the way back is that there. The rod is brought to
    /// the equilibrium with this coefficient where it is.
    ///
    /// ```
    /// use rod_contact::Follower;
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
    /// let mut rod = Follower::new(&rod, &object, clamp(0.9))?.sliding(0.3)?;
    /// rod.to(clamp(0.2))?;
    /// let there = rod.state().reactions;
    /// rod.to(clamp(0.25))?;
    /// rod.to(clamp(0.2))?;
    /// assert!((rod.state().reactions.m0z - there.m0z).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::NotFinite`]; [`ContactError::NotEquilibrium`] where there is no equilibrium with this coefficient.
    pub fn sliding(mut self, coefficient: f64) -> Result<Self, ContactError> {
        // nothing to bring anywhere, as for each rod without friction
        if coefficient == self.sweep.setup().world.sliding() {
            return Ok(self);
        }
        let here = &self.at.configuration;
        self.sweep.stepper.corrector.setup.world.slide(coefficient)?;
        let at = sliding_near(&mut self.sweep.stepper.corrector, here)
            .ok_or(ContactError::NotEquilibrium { reason: "there is none with this friction" })?;
        let at = self.sweep.point_of(at);
        let state = self.sweep.state(&at);
        Ok(Self { at: Box::new(at), state, ..self })
    }

    /// Ends a move with [`StopReason::Jump`] where the equilibrium ends and the rod jumps. To find where it lands costs as much as hundreds of states.
    pub fn without_jumps(mut self) -> Self {
        self.sweep.ends_at_jump = true;
        self
    }

    /// Ends a move with [`StopReason::StepBudget`] after so many steps, refused ones counted; after two million without this.
    pub fn with_most_steps(self, most_steps: u64) -> Self {
        Self { most_steps, ..self }
    }

    /// The rod at the first pose of the path of `sweep`.
    fn at_rest(sweep: Sweep<'a, R>, at: Point) -> Self {
        let (state, pose) = (sweep.state(&at), sweep.setup().path.at(0.0));
        Self { sweep, at: Box::new(at), pose, state, most_steps: LIMITS.sweep.most_steps }
    }

    /// The equilibrium that the rod is in.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Brings the clamp to `pose` (m, radians), straight and at a constant ratio of turn and way: all transitions on the way, in
    /// order, and the state there as the last item. A move shorter than 1e-13 (lengths of the rod plus radians) is none.
    ///
    /// # Errors
    /// [`Stop`] where the rod cannot be followed to there, with the share of the move up to there, 0 to 1, as [`Stop::tau`]. The
    /// rod then stays in the equilibrium in which it was.
    pub fn to(&mut self, pose: Pose) -> Result<Vec<Item>, Stop> {
        if check(pose, ["x", "y", "phi"]).is_err() {
            return Err(Stop { pose: self.state.pose, tau: 0.0, reason: StopReason::NoPose });
        }
        let length = self.sweep.setup().rod.units().length;
        let to = Pose { x: pose.x / length, y: pose.y / length, phi: pose.phi };
        let Some(path) = ClampPath::between(self.pose, to).filter(|path| path.length() > LIMITS.step.same_pose) else {
            return Ok(vec![Item::State(self.state.clone())]);
        };
        let (way, here) = (path.length(), path.at(path.length()));
        self.sweep.stepper.steps_left = self.most_steps;
        self.sweep.set_out(path.into(), Departure::from_end(&self.at));
        self.sweep.course = Course::to_end(way);
        let share = |tau: f64| (tau / way).min(1.0);
        let mut items = Vec::new();
        while let Some(item) = self.sweep.next() {
            items.push(item.map_err(|stop| Stop { tau: share(self.sweep.reached_tau()), ..stop })?);
        }
        if let (Some(Item::State(state)), Stage::Over(end)) = (items.last(), &mut self.sweep.stage)
            && let Some(at) = end.take()
        {
            (self.state, self.at, self.pose) = (state.clone(), at, here);
            return Ok(items);
        }
        // a snap has landed further along the path than the clamp goes
        Err(Stop { tau: 1.0, ..self.sweep.stop(StopReason::NoLanding) })
    }
}

/// The clone looks at the objects anew: bounds of the gap may differ in their last digits.
impl<R: PhysicalRod> Clone for Follower<'_, R> {
    fn clone(&self) -> Self {
        let setup = self.sweep.setup().clone();
        let mut sweep = Sweep::from_setup(setup, LIMITS.sweep.most_steps, 1.0, 0);
        sweep.ends_at_jump = self.sweep.ends_at_jump;
        let Self { at, pose, state, most_steps, .. } = self;
        Self { sweep, at: at.clone(), pose: *pose, state: state.clone(), most_steps: *most_steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_stops_before_a_jump_if_it_is_told_to() {
        use rod_contours::Parabola;
        let (rod, object) =
            (Rod::new(1.0, 1.0).unwrap(), Composite::single(Parabola::new([0.0, 0.0], 5.0).unwrap()).unwrap());
        let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
        let mut rod = Follower::new(&rod, &object, clamp(0.9)).unwrap().without_jumps();
        rod.to(clamp(0.2)).unwrap();
        let before = rod.state().clone();
        let stop = rod.to(clamp(-0.9)).unwrap_err();
        assert_eq!(stop.reason, StopReason::Jump);
        assert!(0.0 < stop.tau && stop.tau < 1.0, "{stop:?}");
        assert_eq!(*rod.state(), before);
        assert_eq!(rod.clone().with_most_steps(1).to(clamp(-0.9)).unwrap_err().reason, StopReason::StepBudget);
        // a copy stops there, too, and so far it can be followed
        let mut copy = rod.clone();
        let almost = 0.2 - 1.1 * stop.tau + 1e-6;
        copy.to(clamp(almost)).unwrap();
        assert_eq!(copy.to(clamp(-0.9)).unwrap_err().reason, StopReason::Jump);
    }

    /// Wherever the rod is cut, each part meets the boxes of all of them: it was halved down to 1e-12 all along.
    #[test]
    fn many_objects_that_overlap_do_not_hold_it_up() {
        use rod_contours::CircularArc;
        let rod = Rod::new(1.0, 1.0).unwrap();
        let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
        let disc = |x| {
            let circle = CircularArc::new([x, 0.2], 0.2, 0.0, std::f64::consts::TAU).unwrap();
            Composite::single(circle).unwrap()
        };
        let pressed = |count: usize, apart: f64| {
            let discs: Vec<Composite> = (0..count).map(|k| disc(apart * k as f64)).collect();
            let mut rod = Follower::new(&rod, &discs, clamp(0.8)).unwrap();
            rod.to(clamp(0.1)).unwrap();
            rod.state().reactions
        };
        // the rod comes from the right and touches the last one of them only
        let (many, one) = (pressed(20, -0.005), pressed(1, 0.0));
        assert!((many.f0x - one.f0x).abs() < 1e-9 && one.f0x.abs() > 0.1, "{many:?} {one:?}");
        assert!((pressed(20, 0.0).f0x - one.f0x).abs() < 1e-9);
    }

    #[test]
    fn it_goes_from_thread_to_thread() {
        fn is_send<T: Send>() {}
        is_send::<Follower<'_>>();
        is_send::<Sweep<'_>>();
    }
}
