//! The rod of a recording.

use crate::naive_touch;
use vibrissa::reconstruct::nalgebra::Matrix3;
use vibrissa::reconstruct::{Touch, one_sample};
use vibrissa::rod::{ElasticClamp, Mounted, PhysicalRod, Reactions, RodError, VaryingRod};
use vibrissa::{Pose, Rod, Sample};

/// The rod of which a recording is, on its clamp.
#[derive(Clone, Debug)]
pub enum GivenRod {
    /// Uniform and straight at rest: everything that Vibrissa knows of recordings can be computed.
    Uniform(Mounted<Rod>),
    /// Its stiffness varies, or it is bent at rest: labels and single contacts can be computed.
    Varying {
        /// The rod.
        rod: Mounted<VaryingRod>,
        /// The uniform, straight rod of its length and of its stiffness at the clamp, for the units.
        alike: Rod,
    },
}

impl From<Rod> for GivenRod {
    fn from(rod: Rod) -> Self {
        Self::Uniform(Mounted::new(rod, ElasticClamp::default()))
    }
}

impl From<Mounted<Rod>> for GivenRod {
    fn from(rod: Mounted<Rod>) -> Self {
        Self::Uniform(rod)
    }
}

impl GivenRod {
    /// A rod whose stiffness varies, or which is bent at rest.
    ///
    /// # Errors
    /// [`RodError`]: its length or its stiffness at the clamp is not possible.
    pub fn varying(rod: Mounted<VaryingRod>) -> Result<Self, RodError> {
        let units = rod.units();
        let alike = Rod::new(units.length, units.force * units.length * units.length)?;
        Ok(Self::Varying { rod, alike })
    }

    /// The rod itself, if it is uniform, otherwise the uniform, straight rod of its length and of its stiffness at the clamp.
    pub fn alike(&self) -> &Rod {
        match self {
            Self::Uniform(rod) => rod.rod(),
            Self::Varying { alike, .. } => alike,
        }
    }

    /// The rod itself, if it is uniform and straight at rest.
    pub fn uniform(&self) -> Option<&Rod> {
        match self {
            Self::Uniform(rod) => Some(rod.rod()),
            Self::Varying { .. } => None,
        }
    }

    /// The contact of a sample as if it were a single one: where the moment vanishes first. For a uniform rod the pose is that of the base,
    /// for another one that of the support.
    pub(crate) fn naive_touch(&self, sample: &Sample) -> Option<Touch> {
        match self {
            Self::Uniform(rod) => naive_touch(rod.rod(), sample),
            Self::Varying { rod, .. } => {
                one_sample(rod, sample.pose, sample.reactions, &Matrix3::zeros()).ok()?.touch()
            }
        }
    }

    /// The pose of the support where the base of a uniform rod is at a pose under these reactions.
    pub(crate) fn support(&self, pose: Pose, reactions: &Reactions) -> Pose {
        match self {
            // the springs yield by the reactions, wherever the support is
            Self::Uniform(rod) if !rod.springs().is_rigid() => {
                let there = rod.base(pose, reactions);
                Pose { x: 2.0 * pose.x - there.x, y: 2.0 * pose.y - there.y, phi: 2.0 * pose.phi - there.phi }
            }
            _ => pose,
        }
    }
}
