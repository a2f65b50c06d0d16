//! How large the errors may be that all samples of a scan share.

use super::source::{Errors, Source};
use rod_core::{Rod, Units};

/// Standard deviations of the errors that all samples of a scan share ([`Source`]), before anything is known from the scan itself.
///
/// ```
/// use rod_core::Rod;
/// use rod_reconstruct::{Budget, Source};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// let budget = Budget { clamp_angle: 2e-3, ..Budget::laboratory(&rod) };
/// assert_eq!((budget.of(Source::ClampAngle), budget.of(Source::GainF0y)), (2e-3, 0.01));
/// assert!(Budget::NONE.is_none() && !budget.is_none());
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Budget {
    /// Bias of f0x, f0y (N) and m0z (N m).
    pub bias: [f64; 3],
    /// Linear drift over the scan of f0x, f0y (N) and m0z (N m).
    pub drift: [f64; 3],
    /// Curved drift, half a sine over the scan, of f0x, f0y (N) and m0z (N m).
    pub bow: [f64; 3],
    /// Relative error of the gain of each channel.
    pub gain: [f64; 3],
    /// Part of one channel that another one shows, forces in EI/L^2 and moments in EI/L.
    pub cross_talk: f64,
    /// Angle of the clamp, radians.
    pub clamp_angle: f64,
    /// Place of the point to which the moment refers, in each direction, m.
    pub lever: f64,
    /// Relative error of the bending stiffness.
    pub stiffness: f64,
    /// Relative error of the rod's length.
    pub length: f64,
    /// Natural curvature of the rod times its length: the angle between the directions of its ends, radians.
    pub natural_curvature: f64,
    /// Compliance of the clamp against rotation, rad/(N m), times EI/L.
    pub clamp_compliance: f64,
    /// Way of the clamp between the time of the reactions and that of the pose, m.
    pub lag: f64,
    /// Relative error of the scale of the stage.
    pub stage_scale: f64,
    /// Coefficient of friction. 0 takes the contacts for frictionless, or for what [`Settings::friction`](crate::Settings::friction) says.
    #[cfg_attr(feature = "serde", serde(default))]
    pub friction: f64,
}

impl Budget {
    /// An ordinary laboratory: a sensor that suits the rod and was not tared, a rod and a clamp that were measured with a caliper. For
    /// a steel rod of 0.1 m and 0.5 mm these are 5 mN and 0.3 mN m of bias and of drift, 1 % of gain, 0.5 degrees, 1 mm, 5 % of
    /// stiffness.
    pub fn laboratory(rod: &Rod) -> Self {
        let Units { length, force, moment, .. } = rod.units();
        let channels = |forces: f64, of_moment: f64| [forces * force, forces * force, of_moment * moment];
        Self {
            bias: channels(0.08, 0.05),
            drift: channels(0.08, 0.05),
            bow: channels(0.016, 0.008),
            gain: [0.01; 3],
            cross_talk: 0.01,
            clamp_angle: 0.5_f64.to_radians(),
            lever: 0.01 * length,
            stiffness: 0.05,
            length: 5e-3,
            natural_curvature: 0.03,
            clamp_compliance: 5e-3,
            lag: 2e-3 * length,
            stage_scale: 5e-3,
            friction: 0.0,
        }
    }

    /// No such errors: samples, rod and poses are taken as they are.
    pub const NONE: Self = Self {
        bias: [0.0; 3],
        drift: [0.0; 3],
        bow: [0.0; 3],
        gain: [0.0; 3],
        cross_talk: 0.0,
        clamp_angle: 0.0,
        lever: 0.0,
        stiffness: 0.0,
        length: 0.0,
        natural_curvature: 0.0,
        clamp_compliance: 0.0,
        lag: 0.0,
        stage_scale: 0.0,
        friction: 0.0,
    };

    /// Whether there are no such errors.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The standard deviation of one source, in its unit.
    pub fn of(&self, source: Source) -> f64 {
        let number = source as usize;
        match source {
            Source::BiasF0x | Source::BiasF0y | Source::BiasM0z => self.bias[number % 3],
            Source::DriftF0x | Source::DriftF0y | Source::DriftM0z => self.drift[number % 3],
            Source::BowF0x | Source::BowF0y | Source::BowM0z => self.bow[number % 3],
            Source::GainF0x | Source::GainF0y | Source::GainM0z => self.gain[number % 3],
            Source::F0yInF0x
            | Source::M0zInF0x
            | Source::F0xInF0y
            | Source::M0zInF0y
            | Source::F0xInM0z
            | Source::F0yInM0z => self.cross_talk,
            Source::ClampAngle => self.clamp_angle,
            Source::LeverAlong | Source::LeverAcross => self.lever,
            Source::Stiffness => self.stiffness,
            Source::Length => self.length,
            Source::NaturalCurvature => self.natural_curvature,
            Source::ClampCompliance => self.clamp_compliance,
            Source::Lag => self.lag,
            Source::StageScale => self.stage_scale,
            Source::Friction => self.friction,
        }
    }

    /// The first standard deviation that is negative or not finite.
    pub(crate) fn fault(&self) -> Option<(Source, f64)> {
        let value = |source: Source| (source, self.of(source));
        Source::ALL.map(value).into_iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0))
    }
}

/// The standard deviations of a budget, dimensionless.
pub(crate) fn deviations(budget: &Budget, rod: &Rod) -> Errors {
    Errors::from_fn(|k, _| budget.of(Source::ALL[k]) / Source::ALL[k].unit(rod))
}
