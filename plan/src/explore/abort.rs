//! When a rig must stop a running scan.

use rod_core::{Reactions, Rod};

/// The reactions at which a rig must stop a running scan and move the clamp back along its path.
///
/// The moment is that of the largest stress at the clamp: below it the rod does not yield there. Along a straight, uniform rod without friction the sum of M^2 / (2 E I) and the
/// force along the rod is the same everywhere, and 0 where only contacts normal to the rod follow. So the moment M is nowhere more than sqrt(2 E I F), with F the
/// force between clamp and first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abort {
    /// Largest moment at the clamp, N m.
    pub moment: f64,
    /// Largest force at the clamp, N: half as much again as expected.
    pub force: f64,
}

/// The moment of a bending stress (Pa), N m; none where the diameter is not known.
pub(super) fn largest_moment(rod: &Rod, stress: f64) -> Option<f64> {
    // E d kappa / 2 at the surface
    Some(rod.bending_stiffness() * stress / rod.bending_stress(1.0)?)
}

impl Abort {
    /// For a largest stress (Pa) and the largest force that is expected (N).
    pub(super) fn of(rod: &Rod, stress: f64, expected_force: f64) -> Option<Self> {
        Some(Self { moment: largest_moment(rod, stress)?, force: 1.5 * expected_force })
    }

    /// Whether a sample is beyond it.
    pub fn is_beyond(&self, reactions: &Reactions) -> bool {
        reactions.m0z.abs() > self.moment || reactions.f0x.hypot(reactions.f0y) > self.force
    }
}
