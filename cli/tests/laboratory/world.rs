//! What differs from the ideal rod before any sensor sees it.

use super::following;
use super::truth::{Site, Truth};

/// Deviations of the rod, the clamp and the contacts from what the inversion assumes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct World {
    /// True angle of the clamp less the angle that the stage is told, rad.
    pub turned: f64,
    /// Natural curvature of the rod, 1/L.
    pub curvature: f64,
    /// Angle by which the clamp gives way, rad per EI/L.
    pub compliance: f64,
    /// Coefficient of Coulomb friction. The rod slides against the direction of the contour at every contact; so it does in the
    /// scenes of the table but for 3 mm of O3_q60 in BA, where one of both contacts would stick or slide back.
    pub friction: f64,
}

impl World {
    pub fn is_ideal(&self) -> bool {
        *self == Self::default()
    }

    /// The sweep of a scene in this world.
    pub fn sweep(&self, site: &Site, step: f64) -> Truth {
        if (Self { turned: 0.0, ..*self }).is_ideal() {
            Truth::sweep(&site.scene, site.path, step, self.turned)
        } else {
            following::sweep(site, *self, step)
        }
    }
}
