//! What differs from the ideal rod before any sensor sees it.

use super::truth::{Site, Truth};

/// Deviations of the rod, the clamp and the object from what the inversion assumes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct World {
    /// True angle of the clamp less the angle that the stage is told, rad.
    pub turned: f64,
}

impl World {
    pub fn is_ideal(&self) -> bool {
        *self == Self::default()
    }

    /// The sweep of a scene in this world.
    pub fn sweep(&self, site: &Site, step: f64) -> Truth {
        Truth::sweep(&site.scene, site.path, step, self.turned)
    }
}
