//! A rod on a clamp that gives way.

use crate::clamp::{Elastic, ElasticClamp};
use crate::elastica::Elastica;
use crate::model::RodModel;
use crate::physical::{PhysicalRod, RodParameter};
use crate::pose::Pose;
use crate::units::Units;

/// A rod whose clamp is on springs: what a solver takes in place of the rod alone.
///
/// The path of a sweep is that of the support. The springs keep the directions of the world when the support turns.
///
/// ```
/// use rod_core::{ElasticClamp, Mounted, PhysicalRod, Pose, Reactions, Rod};
/// let clamp = ElasticClamp::springs(Some(500.0), None, Some(0.4))?; // N/m, rigid, N m/rad
/// let mounted = Mounted::new(Rod::new(0.1, 2e-3)?, clamp);
/// let base = mounted.base(Pose { x: 0.0, y: 0.0, phi: 1.5 }, &Reactions { f0x: 0.5, f0y: 7.0, m0z: 0.04 });
/// // the reactions act on the rod, and push the springs the other way
/// assert!((base.x + 1e-3).abs() < 1e-15 && base.y == 0.0 && (base.phi - 1.4).abs() < 1e-15);
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mounted<R> {
    rod: R,
    clamp: ElasticClamp,
}

impl<R: PhysicalRod<Clamp = Pose>> Mounted<R> {
    /// A rod on a clamp. A rigid clamp is `ElasticClamp::default()`: then the results are those of the rod alone, to the last bit.
    pub fn new(rod: R, clamp: ElasticClamp) -> Self {
        Self { rod, clamp }
    }
}

impl<R> Mounted<R> {
    /// The rod.
    pub fn rod(&self) -> &R {
        &self.rod
    }
}

impl<R: PhysicalRod<Clamp = Pose>> PhysicalRod for Mounted<R> {
    type Model = R::Model;
    type Clamp = Elastic;

    fn model(&self) -> &R::Model {
        self.rod.model()
    }

    fn units(&self) -> Units {
        self.rod.units()
    }

    #[inline(always)]
    fn clamp(&self, pose: Pose) -> Elastic {
        self.clamp.at(pose, &self.units())
    }

    fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        self.rod.curvature_rate(parameter, s, moment)
    }

    fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        self.rod.largest_stress(shape)
    }
}
