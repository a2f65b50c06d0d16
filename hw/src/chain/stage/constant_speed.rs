//! A stage that moves at constant speed.

use super::{StageError, StageSource, finite};
use rod_core::Pose;

/// A stage on a straight path at constant speed. Its pose is known from the start to the end of the motion only.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{ConstantSpeed, StageError, StageSource};
/// let [start, end] = [0.08, -0.08].map(|x| Pose { x, y: -0.04, phi: 1.571 });
/// // 160 mm at 1 mm/s, from 3 s on
/// let mut stage = ConstantSpeed::within(start, end, 3.0, 163.0)?;
/// assert!((stage.pose_at(13.0)?.x - 0.07).abs() < 1e-15);
/// assert!(matches!(stage.pose_at(163.5), Err(StageError::Outside { .. })));
/// # Ok::<(), StageError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed {
    start: Pose,
    velocity: Velocity,
    from: f64,
    to: f64,
    end: Option<Pose>,
}

/// How a pose changes with time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Along x, m/s.
    pub x: f64,
    /// Along y, m/s.
    pub y: f64,
    /// Rate of the clamp angle, rad/s.
    pub phi: f64,
}

impl ConstantSpeed {
    /// From a pose on, which it leaves at time `from` (s), without end.
    ///
    /// ```
    /// use rod_core::Pose;
    /// use rod_hw::{ConstantSpeed, StageSource, Velocity};
    /// let start = Pose { x: 0.0, y: -0.04, phi: 1.571 };
    /// let mut stage = ConstantSpeed::new(start, Velocity { phi: 0.1, ..Velocity::default() }, 0.0)?;
    /// assert_eq!(stage.pose_at(2.0)?.phi, 1.771);
    /// # Ok::<(), rod_hw::StageError>(())
    /// ```
    ///
    /// # Errors
    /// [`StageError::NotFinite`].
    pub fn new(start: Pose, velocity: Velocity, from: f64) -> Result<Self, StageError> {
        let Velocity { x, y, phi } = velocity;
        finite(from, &start)?;
        finite(from, &Pose { x, y, phi })?;
        Ok(Self { start, velocity, from, to: f64::INFINITY, end: None })
    }

    /// From pose to pose on a straight line between two times (s). The clamp turns evenly on the way, or on the spot.
    ///
    /// ```
    /// use rod_core::Pose;
    /// use rod_hw::{ConstantSpeed, StageSource};
    /// let pose = Pose { x: 0.0, y: -0.04, phi: 1.5 };
    /// let mut stage = ConstantSpeed::within(pose, Pose { phi: 1.7, ..pose }, 1.0, 5.0)?;
    /// assert_eq!(stage.pose_at(3.0)?.phi, 1.6);
    /// # Ok::<(), rod_hw::StageError>(())
    /// ```
    ///
    /// # Errors
    /// [`StageError::Backwards`] where it would arrive before it leaves, [`StageError::NotFinite`].
    pub fn within(start: Pose, end: Pose, from: f64, to: f64) -> Result<Self, StageError> {
        finite(to, &end)?;
        if to <= from {
            return Err(StageError::Backwards { from, to });
        }
        let rate = |start: f64, end: f64| (end - start) / (to - from);
        let velocity = Velocity { x: rate(start.x, end.x), y: rate(start.y, end.y), phi: rate(start.phi, end.phi) };
        Ok(Self { to, end: Some(end), ..Self::new(start, velocity, from)? })
    }

    /// The times (s) of leaving and arriving; infinite where it never does.
    pub fn motion(&self) -> (f64, f64) {
        (self.from, self.to)
    }
}

impl StageSource for ConstantSpeed {
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError> {
        let Self { start, velocity, from, to, end } = *self;
        if !t.is_finite() {
            return Err(StageError::NotFinite { t });
        }
        if !(from..=to).contains(&t) {
            return Err(StageError::Outside { t, from, to });
        }
        if let Some(end) = end.filter(|_| t >= to) {
            return Ok(end);
        }
        let since = t - from;
        let pose = Pose {
            x: start.x + velocity.x * since,
            y: start.y + velocity.y * since,
            phi: start.phi + velocity.phi * since,
        };
        finite(t, &pose).map(|()| pose)
    }
}
