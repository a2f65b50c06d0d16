//! The clamp on a straight line.

use super::{Path, PathPoint};
use crate::error::{ContactError, LARGEST_ANGLE};
use rod_core::{Pose, Units};

/// The error for a pose with a number that cannot be; `names` are those of its x, y and angle.
pub(crate) fn check(pose: Pose, names: [&'static str; 3]) -> Result<(), ContactError> {
    for (what, value) in names.into_iter().zip([pose.x, pose.y, pose.phi]) {
        if !value.is_finite() {
            return Err(ContactError::NotFinite { what, value });
        }
    }
    let (what, value) = (names[2], pose.phi);
    if value.abs() > LARGEST_ANGLE { Err(ContactError::Angle { what, value }) } else { Ok(()) }
}

/// A straight path of the clamp: translation in any direction, rotation, or both at once, at a constant ratio.
///
/// Its parameter runs from 0 to [`length`](Self::length): the way of the clamp in m, or, where the clamp only turns, the
/// angle in radians.
///
/// ```
/// use rod_contact::ClampPath;
/// use rod_core::Pose;
/// let up = std::f64::consts::FRAC_PI_2;
/// let path = ClampPath::new(Pose { x: 0.07, y: -0.04, phi: up }, Pose { x: -0.09, y: -0.04, phi: up })?;
/// assert!((path.length() - 0.16).abs() < 1e-15);
/// assert!((path.at(0.07).x).abs() < 1e-15);
/// # Ok::<(), rod_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClampPath {
    from: Pose,
    to: Pose,
    length: f64,
}

impl ClampPath {
    /// The path from one pose of the clamp to another (m, m, radians). The angle is followed as given, whole turns
    /// included.
    ///
    /// Angles are radians. One of more than 100 rad is refused.
    ///
    /// # Errors
    /// [`ContactError::NotFinite`], [`ContactError::Angle`], or [`ContactError::NoPath`] where the two poses are the same.
    pub fn new(from: Pose, to: Pose) -> Result<Self, ContactError> {
        check(from, ["from.x", "from.y", "from.phi"])?;
        check(to, ["to.x", "to.y", "to.phi"])?;
        let way = (to.x - from.x).hypot(to.y - from.y);
        let length = if way > 0.0 { way } else { (to.phi - from.phi).abs() };
        if length > 0.0 { Ok(Self { from, to, length }) } else { Err(ContactError::NoPath { pose: from }) }
    }

    /// Length of the path: m, or radians where the clamp only turns.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Pose at `tau` along the path; beyond its ends it goes on as it was.
    pub fn at(&self, tau: f64) -> Pose {
        let rate = self.rate();
        Pose { x: self.from.x + rate.x * tau, y: self.from.y + rate.y * tau, phi: self.from.phi + rate.phi * tau }
    }

    /// Change of the pose by the path parameter.
    pub fn rate(&self) -> Pose {
        Pose {
            x: (self.to.x - self.from.x) / self.length,
            y: (self.to.y - self.from.y) / self.length,
            phi: (self.to.phi - self.from.phi) / self.length,
        }
    }

    /// A path (dimensionless) on which lengths and angles count alike, so that one that hardly moves but turns has a
    /// parameter that is not tiny; none where both poses are the same.
    pub(crate) fn between(from: Pose, to: Pose) -> Option<Self> {
        let length = (to.x - from.x).hypot(to.y - from.y) + (to.phi - from.phi).abs();
        (length > 0.0).then_some(Self { from, to, length })
    }

    /// The path (dimensionless) that goes on from a pose at a rate.
    pub(crate) fn along(from: Pose, rate: Pose) -> Self {
        let to = Pose { x: from.x + rate.x, y: from.y + rate.y, phi: from.phi + rate.phi };
        Self { from, to, length: 1.0 }
    }

    /// The first pose.
    pub(crate) fn from(&self) -> Pose {
        self.from
    }

    /// A path that stays where it is.
    pub(crate) fn standing(pose: Pose) -> Self {
        Self { from: pose, to: pose, length: 1.0 }
    }

    /// Other paths (dimensionless) through a pose at 0: turning there, and sideways across the rod, either way.
    pub(crate) fn others_to(here: Pose) -> [Self; 4] {
        let (sin, cos) = here.phi.sin_cos();
        [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)].map(|(sideways, turned)| {
            let to = Pose { x: here.x - sideways * sin, y: here.y + sideways * cos, phi: here.phi + turned };
            Self { from: here, to, length: 1.0 }
        })
    }

    /// The same path in dimensionless lengths.
    pub(crate) fn dimensionless(&self, units: Units) -> Self {
        let scale = |p: Pose| Pose { x: p.x / units.length, y: p.y / units.length, phi: p.phi };
        let length = if self.turns_only() { self.length } else { self.length / units.length };
        Self { from: scale(self.from), to: scale(self.to), length }
    }

    /// Whether the clamp turns without moving.
    pub fn turns_only(&self) -> bool {
        self.from.x == self.to.x && self.from.y == self.to.y
    }
}

impl Path for ClampPath {
    fn point(&self, t: f64) -> PathPoint {
        PathPoint { pose: self.at(t), rate: self.rate() }
    }

    fn length(&self) -> f64 {
        self.length
    }

    fn straight(&self) -> Option<ClampPath> {
        Some(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(from: f64, to: f64) -> Result<ClampPath, ContactError> {
        ClampPath::new(Pose { x: 0.0, y: 0.0, phi: from }, Pose { x: 0.1, y: 0.0, phi: to })
    }

    #[test]
    fn an_angle_too_large_is_refused() {
        assert_eq!(path(180.0, 0.0), Err(ContactError::Angle { what: "from.phi", value: 180.0 }));
        let error = path(0.0, -100.5).unwrap_err().to_string();
        assert_eq!(error, "to.phi is -100.5 rad, expected at most 100 rad either way");
        assert!(path(100.0, -100.0).is_ok());
        assert!(matches!(path(f64::INFINITY, 0.0), Err(ContactError::NotFinite { what: "from.phi", .. })));
    }
}
