//! A stage that moves at constant speed.

use super::{StageError, StageSource, finite};
use rod_core::Pose;

/// A stage on a straight path at constant speed. Unless it [`rests`](Self::resting_at_its_ends), its pose is known from the
/// start to the end of the motion only.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{ConstantSpeed, StageError, StageSource};
/// let [start, end] = [0.08, -0.08].map(|x| Pose { x, y: -0.04, phi: 1.571 });
/// // 160 mm at 1 mm/s, from 3 s on
/// let mut stage = ConstantSpeed::along(start, end, 1e-3, 3.0)?;
/// assert!((stage.pose_at(13.0)?.x - 0.07).abs() < 1e-15);
/// assert!(matches!(stage.pose_at(163.5), Err(StageError::Outside { .. })));
/// // it stands still before and after
/// let mut stage = stage.resting_at_its_ends();
/// assert_eq!((stage.pose_at(0.0)?, stage.pose_at(200.0)?), (start, end));
/// # Ok::<(), StageError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed {
    start: Pose,
    velocity: Velocity,
    from: f64,
    to: f64,
    end: Option<Pose>,
    rests: bool,
}

/// How a pose changes with time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Along x, m/s.
    pub x: f64,
    /// Along y, m/s.
    pub y: f64,
    /// Of the clamp angle, rad/s.
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
        Ok(Self { start, velocity, from, to: f64::INFINITY, end: None, rests: false })
    }

    /// From pose to pose on a straight line at `speed` (m/s) from time `from` (s) on. The clamp turns evenly on the way.
    ///
    /// # Errors
    /// [`StageError::Motion`] where the poses are at the same place or the speed is not above 0, [`StageError::NotFinite`].
    pub fn along(start: Pose, end: Pose, speed: f64, from: f64) -> Result<Self, StageError> {
        let way = rod_core::Scalar::sqrt((end.x - start.x) * (end.x - start.x) + (end.y - start.y) * (end.y - start.y));
        if way > 0.0 && speed > 0.0 {
            Self::within(start, end, from, from + way / speed)
        } else {
            Err(StageError::Motion { way, speed })
        }
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

    /// One that stands still at its first pose before it leaves, and at its last one when it has arrived.
    pub fn resting_at_its_ends(self) -> Self {
        Self { rests: true, ..self }
    }

    /// The times (s) of leaving and arriving; infinite where it never does.
    pub fn motion(&self) -> (f64, f64) {
        (self.from, self.to)
    }
}

impl StageSource for ConstantSpeed {
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError> {
        let Self { start, velocity, from, to, end, rests } = *self;
        if !t.is_finite() {
            return Err(StageError::NotFinite { t });
        }
        if !rests && !(from..=to).contains(&t) {
            return Err(StageError::Outside { t, from, to });
        }
        if let Some(end) = end.filter(|_| t >= to) {
            return Ok(end);
        }
        let since = (t - from).max(0.0);
        let pose = Pose {
            x: start.x + velocity.x * since,
            y: start.y + velocity.y * since,
            phi: start.phi + velocity.phi * since,
        };
        finite(t, &pose).map(|()| pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };

    #[test]
    fn by_speed_and_by_time_are_the_same() {
        let end = Pose { x: 0.03, y: -0.04, phi: 0.5 };
        let mut by_speed = ConstantSpeed::along(START, end, 5e-3, 1.0).unwrap();
        let mut by_time = ConstantSpeed::within(START, end, 1.0, 11.0).unwrap();
        assert_eq!(by_speed.motion(), (1.0, 11.0));
        for t in [1.0, 2.0, 10.9, 11.0] {
            assert_eq!(by_speed.pose_at(t), by_time.pose_at(t));
        }
        assert_eq!(by_speed.pose_at(11.0), Ok(end));
        assert_eq!(by_speed.pose_at(0.5), Err(StageError::Outside { t: 0.5, from: 1.0, to: 11.0 }));
        assert!(matches!(by_speed.pose_at(f64::NAN), Err(StageError::NotFinite { .. })));
    }

    #[test]
    fn refuses() {
        let end = Pose { x: 0.1, ..START };
        for speed in [0.0, -1e-3, f64::NAN] {
            let error = ConstantSpeed::along(START, end, speed, 0.0).unwrap_err().to_string();
            assert_eq!(error, format!("a way of 0.1 m at {speed} m/s, expected both above 0"));
        }
        assert!(matches!(ConstantSpeed::along(START, end, 1e-3, f64::NAN), Err(StageError::NotFinite { .. })));
        assert!(ConstantSpeed::along(START, Pose { phi: 1.0, ..START }, 1e-3, 0.0).is_err());
        assert!(ConstantSpeed::within(START, end, 2.0, 2.0).is_err());
        let astray = Velocity { x: f64::INFINITY, ..Velocity::default() };
        assert!(ConstantSpeed::new(START, astray, 0.0).is_err());
    }
}
