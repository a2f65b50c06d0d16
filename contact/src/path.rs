//! The way the clamp goes.

use crate::error::ContactError;
use rod_core::{Pose, Units};

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
    /// # Errors
    /// [`ContactError::NotFinite`], or [`ContactError::NoPath`] where the two poses are the same.
    pub fn new(from: Pose, to: Pose) -> Result<Self, ContactError> {
        for (what, value) in [
            ("from.x", from.x),
            ("from.y", from.y),
            ("from.phi", from.phi),
            ("to.x", to.x),
            ("to.y", to.y),
            ("to.phi", to.phi),
        ] {
            if !value.is_finite() {
                return Err(ContactError::NotFinite { what, value });
            }
        }
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

    /// A path that stays where it is.
    pub(crate) fn standing(pose: Pose) -> Self {
        Self { from: pose, to: pose, length: 1.0 }
    }

    /// Other paths through the first pose at 0: turning there, and sideways across the rod, either way.
    pub(crate) fn others_to_its_start(&self) -> [Self; 4] {
        let here = self.from;
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
