//! A rod that runs through a roller ahead of its clamp.

use crate::clamp::{Clamp, Roller};
use crate::elastica::Elastica;
use crate::error::RodError;
use crate::model::RodModel;
use crate::physical::{PhysicalRod, RodParameter};
use crate::pose::Pose;
use crate::units::Units;

/// A rigid clamp with a roller ahead of it, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollerClamp {
    /// The clamp.
    pub pose: Pose,
    /// The roller, which moves and turns with it.
    pub roller: Roller,
}

impl Clamp for RollerClamp {
    #[inline(always)]
    fn pose(&self) -> Pose {
        self.pose
    }
    #[inline(always)]
    fn roller(&self) -> Option<Roller> {
        Some(self.roller)
    }
}

/// A rod that runs through a roller ahead of its rigid clamp: what a solver takes in place of the rod alone.
///
/// The roller is frictionless, has no size, and holds the rod on both sides (a pair of rollers). It is fixed to the clamp where the rod at
/// rest is at a given arc length: of a straight rod, that far ahead of the clamp along phi0. The clamp stays rigid, and what it feels is
/// what the roller leaves to it.
///
/// ```
/// use rod_core::{Guided, Rod};
/// assert!(Guided::new(Rod::new(0.1, 2e-3)?, 0.02).is_ok()); // m
/// let message = Guided::new(Rod::new(0.1, 2e-3)?, 0.2).unwrap_err().to_string();
/// assert_eq!(message, "clamp.roller is 0.2, expected a number above 0 and below 0.1, the length of the rod");
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Guided<R> {
    rod: R,
    roller: Roller,
}

impl<R: PhysicalRod<Clamp = Pose>> Guided<R> {
    /// A rod with a roller where it is at rest at the arc length `roller` (m).
    ///
    /// Forces of roller and clamp are exact to about 1e-16 E I / `roller`^2.
    ///
    /// # Errors
    /// [`RodError::Roller`] for what is not between 0 and the length of the rod.
    pub fn new(rod: R, roller: f64) -> Result<Self, RodError> {
        let length = rod.units().length;
        let is_on_rod = roller > 0.0 && roller < length;
        if !is_on_rod {
            return Err(RodError::Roller { value: roller, length });
        }
        let dimensionless = Roller::of(rod.model(), roller / length);
        Ok(Self { rod, roller: dimensionless })
    }
}

impl<R> Guided<R> {
    /// The rod.
    pub fn rod(&self) -> &R {
        &self.rod
    }

    pub(crate) fn dimensionless(&self) -> Roller {
        self.roller
    }
}

impl<R: PhysicalRod<Clamp = Pose>> PhysicalRod for Guided<R> {
    type Model = R::Model;
    type Clamp = RollerClamp;

    fn model(&self) -> &R::Model {
        self.rod.model()
    }

    fn units(&self) -> Units {
        self.rod.units()
    }

    #[inline(always)]
    fn clamp(&self, pose: Pose) -> RollerClamp {
        RollerClamp { pose, roller: self.roller }
    }

    fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        self.rod.curvature_rate(parameter, s, moment)
    }

    fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        self.rod.largest_stress(shape)
    }
}
