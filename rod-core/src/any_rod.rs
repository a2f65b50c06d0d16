//! A rod of any kind on any clamp, as one type.

use crate::clamp::{Clamp, ClampLaw, ElasticClamp, Roller};
use crate::elastica::Elastica;
use crate::error::RodError;
use crate::model::{Cut, CutSensitivities, RodModel, Uniform};
use crate::physical::{Guided, PhysicalRod, RodParameter};
use crate::pose::Pose;
use crate::rod::Rod;
use crate::segment::{Segment, Station};
use crate::units::Units;
use crate::varying::VaryingRod;

/// A rod of any kind on any clamp: for programs that learn only at run time which it is. [`RodSpec`](crate::RodSpec) makes it from the
/// fields of a file.
///
/// It is a [`PhysicalRod`]: every solver takes it, and gives the numbers of the rod's own type, to the last bit. A uniform rod keeps its closed
/// form; of which kind the rod is, is asked at each segment.
///
/// ```
/// use rod_core::{AnyRod, ElasticClamp, PhysicalRod, Rod};
/// let rod = AnyRod::from(Rod::new(0.1, 2e-3)?).with_springs(ElasticClamp::springs(None, None, Some(0.4))?);
/// assert!(rod.uniform().is_some() && rod.springs().is_some());
/// let bent = AnyRod::from(Rod::new(0.1, 2e-3)?.with_natural_curvature(5.0)?);
/// assert!(bent.uniform().is_none() && bent.is_held_rigidly());
/// assert_eq!((bent.length(), bent.at_clamp().bending_stiffness()), (0.1, 2e-3));
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AnyRod {
    kind: Kind,
    mounting: Mounting,
}

#[derive(Clone, Debug)]
enum Kind {
    Uniform(Rod),
    Varying(VaryingRod),
}

/// What holds the base.
#[derive(Clone, Copy, Debug)]
enum Mounting {
    Rigid,
    Springs(ElasticClamp),
    /// `distance` in m, for the user; the roller itself is dimensionless.
    Roller {
        distance: f64,
        roller: Roller,
    },
}

impl From<Rod> for AnyRod {
    fn from(rod: Rod) -> Self {
        Self { kind: Kind::Uniform(rod), mounting: Mounting::Rigid }
    }
}

impl From<VaryingRod> for AnyRod {
    fn from(rod: VaryingRod) -> Self {
        Self { kind: Kind::Varying(rod), mounting: Mounting::Rigid }
    }
}

impl AnyRod {
    /// The same rod on springs in place of what holds it. Springs that give way nowhere are a rigid clamp.
    #[must_use]
    pub fn with_springs(self, springs: ElasticClamp) -> Self {
        let mounting = if springs.is_rigid() { Mounting::Rigid } else { Mounting::Springs(springs) };
        Self { mounting, ..self }
    }

    /// The same rod, clamped rigidly, through a roller where it is at rest at the arc length `distance` (m).
    ///
    /// # Errors
    /// [`RodError::Roller`] as [`Guided::new`].
    pub fn with_roller(self, distance: f64) -> Result<Self, RodError> {
        let roller = match &self.kind {
            Kind::Uniform(rod) => Guided::new(*rod, distance)?.dimensionless(),
            Kind::Varying(rod) => Guided::new(rod.clone(), distance)?.dimensionless(),
        };
        Ok(Self { mounting: Mounting::Roller { distance, roller }, ..self })
    }

    /// The rod itself, if it is uniform and straight at rest, on whatever clamp.
    pub fn uniform(&self) -> Option<&Rod> {
        match &self.kind {
            Kind::Uniform(rod) => Some(rod),
            Kind::Varying(_) => None,
        }
    }

    /// The same, if nothing but a rigid clamp holds it.
    pub fn uniform_on_rigid_clamp(&self) -> Option<&Rod> {
        self.uniform().filter(|_| self.is_held_rigidly())
    }

    /// The rod itself, if its stiffness varies or it is bent at rest, on whatever clamp.
    pub fn varying(&self) -> Option<&VaryingRod> {
        match &self.kind {
            Kind::Uniform(_) => None,
            Kind::Varying(rod) => Some(rod),
        }
    }

    /// The uniform, straight rod of its length and of its stiffness at the clamp, on which its units rest: the rod itself where that is
    /// uniform.
    pub fn at_clamp(&self) -> &Rod {
        match &self.kind {
            Kind::Uniform(rod) => rod,
            Kind::Varying(rod) => rod.at_clamp(),
        }
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.at_clamp().length()
    }

    /// What its dimensionless units are in SI: those of its length and of its stiffness at the clamp.
    pub fn units(&self) -> Units {
        self.at_clamp().units()
    }

    /// The springs of its clamp, if that gives way.
    pub fn springs(&self) -> Option<&ElasticClamp> {
        match &self.mounting {
            Mounting::Springs(springs) => Some(springs),
            _ => None,
        }
    }

    /// Arc length at rest from the clamp to the roller (m), if there is one.
    pub fn roller(&self) -> Option<f64> {
        match self.mounting {
            Mounting::Roller { distance, .. } => Some(distance),
            _ => None,
        }
    }

    /// Whether its clamp is rigid and has no roller.
    pub fn is_held_rigidly(&self) -> bool {
        matches!(self.mounting, Mounting::Rigid)
    }
}

/// The clamp of an [`AnyRod`], dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyClamp {
    pose: Pose,
    law: Option<ClampLaw>,
    roller: Option<Roller>,
}

impl Clamp for AnyClamp {
    #[inline(always)]
    fn pose(&self) -> Pose {
        self.pose
    }
    #[inline(always)]
    fn law(&self) -> Option<ClampLaw> {
        self.law
    }
    #[inline(always)]
    fn roller(&self) -> Option<Roller> {
        self.roller
    }
}

impl PhysicalRod for AnyRod {
    type Model = Self;
    type Clamp = AnyClamp;

    fn model(&self) -> &Self {
        self
    }

    fn units(&self) -> Units {
        Self::units(self)
    }

    fn clamp(&self, pose: Pose) -> AnyClamp {
        let rigid = AnyClamp { pose, law: None, roller: None };
        match &self.mounting {
            Mounting::Rigid => rigid,
            Mounting::Springs(springs) => AnyClamp { law: springs.at(pose, &self.units()).law(), ..rigid },
            Mounting::Roller { roller, .. } => AnyClamp { roller: Some(*roller), ..rigid },
        }
    }

    fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        match &self.kind {
            Kind::Uniform(rod) => rod.curvature_rate(parameter, s, moment),
            Kind::Varying(rod) => rod.curvature_rate(parameter, s, moment),
        }
    }

    fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        match &self.kind {
            Kind::Uniform(rod) => rod.largest_stress(shape),
            Kind::Varying(rod) => rod.largest_stress(shape),
        }
    }
}

/// What the model of either kind answers.
macro_rules! ask {
    ($rod:expr, $model:ident => $answer:expr) => {
        match &$rod.kind {
            Kind::Uniform(_) => {
                let $model = &Uniform;
                $answer
            }
            Kind::Varying($model) => $answer,
        }
    };
}

/// In units of its length and of its stiffness at the clamp.
impl RodModel for AnyRod {
    #[inline(always)]
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        ask!(self, model => model.carry_with_sensitivities(s, start, a, b, length))
    }
    #[inline(always)]
    fn curvature_at(&self, s: f64, moment: f64) -> f64 {
        ask!(self, model => model.curvature_at(s, moment))
    }
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        ask!(self, model => model.bending_energy(segment, to, end))
    }
    fn bending_energy_by_parts(
        &self,
        segment: &Segment<Cut>,
        to: f64,
        end: &Cut,
        show: &mut dyn FnMut(Segment<Cut>),
    ) -> f64 {
        ask!(self, model => model.bending_energy_by_parts(segment, to, end, show))
    }
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        ask!(self, model => model.largest_curvature(segment, to, end))
    }
    fn largest_free_curvature(&self, s: f64, start: &Cut, to: f64) -> f64 {
        ask!(self, model => model.largest_free_curvature(s, start, to))
    }
    #[inline(always)]
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        ask!(self, model => model.curvature_bounds(from, to, force))
    }
    #[inline(always)]
    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        ask!(self, model => model.one_bend(from, to, force))
    }
    #[inline(always)]
    fn least_stiffness(&self, from: f64, to: f64) -> f64 {
        ask!(self, model => model.least_stiffness(from, to))
    }
    #[inline(always)]
    fn is_straight(&self) -> bool {
        ask!(self, model => model.is_straight())
    }
    #[inline(always)]
    fn is_uniform(&self) -> bool {
        matches!(self.kind, Kind::Uniform(_))
    }
    #[inline(always)]
    fn joints(&self) -> &[f64] {
        ask!(self, model => model.joints())
    }
    fn stations(&self, segment: &Segment<Cut>, parts: (f64, usize), count: usize, visit: impl FnMut(Station)) {
        ask!(self, model => model.stations(segment, parts, count, visit));
    }
    #[inline(always)]
    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        ask!(self, model => model.carry(s, start, a, b, length))
    }
    #[inline(always)]
    fn natural_curvature(&self, s: f64) -> f64 {
        ask!(self, model => model.natural_curvature(s))
    }
}
