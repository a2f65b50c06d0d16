//! A rod in SI units, and the model that computes it.

mod guided;
mod mounted;

pub use guided::{Guided, RollerClamp};
pub use mounted::Mounted;

use crate::clamp::Clamp;
use crate::elastica::Elastica;
use crate::model::{RodModel, Uniform};
use crate::pose::{Pose, Reactions};
use crate::rod::Rod;
use crate::units::Units;

/// A rod in SI units with its clamp: what a solver takes. [`Rod`] is the uniform straight one, [`VaryingRod`](crate::VaryingRod) any other; both are
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

    /// The change of the curvature (1/L) at arc length `s` (L) under the bending moment `moment` (E I / L) per unit of a parameter of the rod
    /// (in SI); none where the rod has no such parameter. The units, those of the length and of the stiffness at the clamp, stay as they
    /// are.
    fn curvature_rate(&self, _parameter: RodParameter, _s: f64, _moment: f64) -> Option<f64> {
        None
    }

    /// The largest bending stress (Pa) at the surface of this rod, bent to `shape`: E d |kappa - kappa0| / 2, none where the diameter d is
    /// not known.
    fn largest_stress<M: RodModel>(&self, _shape: &Elastica<M>) -> Option<f64> {
        None
    }
}

/// A parameter of a rod by which to differentiate. Sections are counted from 0, from the clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RodParameter {
    /// The taper of a cone: 1 - diameter at the tip / diameter at the clamp, with the diameter at the clamp as it is.
    Taper,
    /// The bending stiffness of a section, N m^2.
    SectionStiffness(usize),
    /// The natural curvature of a section, 1/m.
    SectionCurvature(usize),
    /// The natural curvature of the whole rod, 1/m: what is added to it all along.
    NaturalCurvature,
}

impl std::fmt::Display for RodParameter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Taper => f.write_str("taper"),
            Self::SectionStiffness(section) => write!(f, "bending stiffness of section {section}"),
            Self::SectionCurvature(section) => write!(f, "natural curvature of section {section}"),
            Self::NaturalCurvature => f.write_str("natural curvature"),
        }
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

    fn curvature_rate(&self, parameter: RodParameter, _s: f64, _moment: f64) -> Option<f64> {
        (parameter == RodParameter::NaturalCurvature).then(|| self.length())
    }

    fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        self.diameter()?;
        self.bending_stress(shape.largest_curvature())
    }
}
