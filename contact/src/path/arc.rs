//! The clamp on a circle.

use super::{Path, PathPoint, check};
use crate::error::ContactError;
use rod_core::Pose;

/// A path along a circular arc, on which the clamp may turn: with the arc, as about a pivot, or on its own.
///
/// Its parameter runs from 0 to the way of the clamp in m, or, where the clamp is at the centre, to the angle in radians.
///
/// ```
/// use rod_contact::{ClampArc, Path};
/// use rod_core::Pose;
/// use std::f64::consts::FRAC_PI_2;
/// // a whisker whose follicle turns about a pivot 5 mm behind its base: protraction by 40 degrees
/// let base = Pose { x: 0.0, y: 0.0, phi: FRAC_PI_2 };
/// let protraction = ClampArc::about(base, [0.0, -5e-3], -40_f64.to_radians())?;
/// let end = protraction.point(protraction.length()).pose;
/// assert!((end.phi - 50_f64.to_radians()).abs() < 1e-15 && (end.x - 5e-3 * 40_f64.to_radians().sin()).abs() < 1e-15);
/// # Ok::<(), rod_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClampArc {
    center: [f64; 2],
    radius: f64,
    /// Direction from the centre to the clamp at the start, and how far that and the clamp turn, rad.
    direction: f64,
    turn: f64,
    phi: f64,
    phi_turn: f64,
    length: f64,
}

impl ClampArc {
    /// The arc from a pose by an angle (radians, counter-clockwise) about `center` (m), on which the clamp turns to `phi_to`.
    ///
    /// # Errors
    /// [`ContactError::NotFinite`], [`ContactError::Angle`], or [`ContactError::NoPath`] where nothing moves.
    pub fn new(from: Pose, center: [f64; 2], turn: f64, phi_to: f64) -> Result<Self, ContactError> {
        check(from, ["from.x", "from.y", "from.phi"])?;
        check(Pose { x: center[0], y: center[1], phi: turn }, ["center[0]", "center[1]", "turn"])?;
        check(Pose { phi: phi_to, ..from }, ["from.x", "from.y", "phi_to"])?;
        let (dx, dy) = (from.x - center[0], from.y - center[1]);
        let (radius, phi_turn) = (dx.hypot(dy), phi_to - from.phi);
        let way = radius * turn.abs();
        let length = if way > 0.0 { way } else { phi_turn.abs() };
        if length > 0.0 {
            Ok(Self { center, radius, direction: dy.atan2(dx), turn, phi: from.phi, phi_turn, length })
        } else {
            Err(ContactError::NoPath { pose: from })
        }
    }

    /// The rotation of the clamp about a pivot (m) by an angle (radians, counter-clockwise), as of a whisker about its follicle.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn about(from: Pose, pivot: [f64; 2], turn: f64) -> Result<Self, ContactError> {
        Self::new(from, pivot, turn, from.phi + turn)
    }

    /// Whether the clamp turns without moving.
    pub fn turns_only(&self) -> bool {
        self.radius * self.turn.abs() == 0.0
    }
}

impl Path for ClampArc {
    fn point(&self, t: f64) -> PathPoint {
        let share = t / self.length;
        let (sin, cos) = (self.direction + share * self.turn).sin_cos();
        let [x, y] = self.center;
        let speed = self.radius * self.turn / self.length;
        PathPoint {
            pose: Pose { x: x + self.radius * cos, y: y + self.radius * sin, phi: self.phi + share * self.phi_turn },
            rate: Pose { x: -speed * sin, y: speed * cos, phi: self.phi_turn / self.length },
        }
    }

    fn length(&self) -> f64 {
        self.length
    }
}
