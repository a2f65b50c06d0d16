//! A rod in SI units, and the model that computes it.

use crate::model::{RodModel, Uniform};
use crate::rod::Rod;
use crate::units::Units;
use crate::varying::VaryingRod;

/// A rod in SI units: what a solver takes. [`Rod`] is the uniform straight one, [`VaryingRod`] any other.
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

    /// The model.
    fn model(&self) -> &Self::Model;

    /// What the dimensionless units are in SI.
    fn units(&self) -> Units;

    /// Bending stress (Pa) where the curvature is `kappa` (1/m); none where the thickness is not known.
    fn bending_stress(&self, _kappa: f64) -> Option<f64> {
        None
    }
}

impl PhysicalRod for Rod {
    type Model = Uniform;

    #[inline(always)]
    fn model(&self) -> &Uniform {
        &Uniform
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

    fn model(&self) -> &Self {
        self
    }

    fn units(&self) -> Units {
        Self::units(self)
    }
}
