//! A rod in SI units, and the model that computes it.

use crate::clamp::Clamp;
use crate::model::{RodModel, Uniform};
use crate::pose::{Pose, Reactions};
use crate::rod::Rod;
use crate::units::Units;
use crate::varying::VaryingRod;

/// A rod in SI units with its clamp: what a solver takes. [`Rod`] is the uniform straight one, [`VaryingRod`] any other; both are
/// clamped rigidly, and [`Mounted`](crate::Mounted) puts either on springs.
///
/// ```
/// use rod_core::{PhysicalRod, Rod, RodModel};
/// fn tip_stiffness(rod: &impl PhysicalRod) -> f64 {
///     rod.model().least_stiffness(1.0, 1.0) * rod.units().force * rod.units().length.powi(2) // N m^2
/// }
/// let (base, tip) = (1e-4, 0.5e-4);
/// let [uniform, cone] = [tip_stiffness(&Rod::tapered(0.04, base, base, 3e9)?), tip_stiffness(&Rod::tapered(0.04, base, tip, 3e9)?)];
/// assert!((cone / uniform - 0.0625).abs() < 1e-12);
/// # Ok::<(), rod_core::RodError>(())
/// ```
pub trait PhysicalRod: Clone {
    /// What computes it, in units of its length and its stiffness at the clamp.
    type Model: RodModel + Clone;
    /// What holds its base: a [`Pose`] is the rigid clamp.
    type Clamp: Clamp;

    /// The model.
    fn model(&self) -> &Self::Model;

    /// What the dimensionless units are in SI.
    fn units(&self) -> Units;

    /// Its clamp with the support at `pose`, both dimensionless.
    fn clamp(&self, pose: Pose) -> Self::Clamp;

    /// Where the base of the rod is (m, rad) while its support is at `pose` (m, rad) and the reactions are these (N, N m): at `pose` itself
    /// on a rigid clamp, to the last bit.
    fn base(&self, pose: Pose, reactions: &Reactions) -> Pose {
        let Units { length, force, moment, .. } = self.units();
        let clamp = self.clamp(Pose { x: pose.x / length, y: pose.y / length, phi: pose.phi });
        if clamp.law().is_none() {
            return pose;
        }
        let Reactions { f0x, f0y, m0z } = reactions;
        let Pose { x, y, phi } = clamp.base(&Reactions { f0x: f0x / force, f0y: f0y / force, m0z: m0z / moment });
        Pose { x: x * length, y: y * length, phi }
    }

    /// Bending stress (Pa) where the curvature is `kappa` (1/m); none where the thickness is not known.
    fn bending_stress(&self, _kappa: f64) -> Option<f64> {
        None
    }
}

impl PhysicalRod for Rod {
    type Model = Uniform;
    type Clamp = Pose;

    #[inline(always)]
    fn model(&self) -> &Uniform {
        &Uniform
    }

    #[inline(always)]
    fn clamp(&self, pose: Pose) -> Pose {
        pose
    }

    #[inline(always)]
    fn units(&self) -> Units {
        Self::units(self)
    }

    fn bending_stress(&self, kappa: f64) -> Option<f64> {
        Self::bending_stress(self, kappa)
    }
}

impl PhysicalRod for VaryingRod {
    type Model = Self;
    type Clamp = Pose;

    fn model(&self) -> &Self {
        self
    }

    fn clamp(&self, pose: Pose) -> Pose {
        pose
    }

    fn units(&self) -> Units {
        Self::units(self)
    }
}
