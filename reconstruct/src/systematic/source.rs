//! The sources of errors that all samples of a scan share.

use nalgebra::{SMatrix, SVector};
use rod_core::Rod;
use std::fmt;

/// Number of sources.
pub(crate) const SOURCES: usize = 28;

/// One number for each source, dimensionless (lengths in L, forces in EI/L^2, moments in EI/L).
pub(crate) type Errors = SVector<f64, SOURCES>;
/// A covariance of such numbers, or a factor of one.
pub(crate) type Joint = SMatrix<f64, SOURCES, SOURCES>;

/// A source of an error that all samples of a scan share. Each is one number, in the unit given here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Source {
    /// What the sensor shows without load in the middle of the scan, N.
    BiasF0x,
    /// The same for f0y, N.
    BiasF0y,
    /// The same for m0z, N m.
    BiasM0z,
    /// Linear drift from the begin to the end of the scan, N.
    DriftF0x,
    /// The same for f0y, N.
    DriftF0y,
    /// The same for m0z, N m.
    DriftM0z,
    /// Drift that is greatest in the middle of the scan and 0 at both ends, N.
    BowF0x,
    /// The same for f0y, N.
    BowF0y,
    /// The same for m0z, N m.
    BowM0z,
    /// By how much f0x is too large, relative.
    GainF0x,
    /// The same for f0y.
    GainF0y,
    /// The same for m0z.
    GainM0z,
    /// Part of f0y that f0x shows.
    F0yInF0x,
    /// Part of m0z / L that f0x shows.
    M0zInF0x,
    /// Part of f0x that f0y shows.
    F0xInF0y,
    /// Part of m0z / L that f0y shows.
    M0zInF0y,
    /// Part of f0x L that m0z shows.
    F0xInM0z,
    /// Part of f0y L that m0z shows.
    F0yInM0z,
    /// True angle of the clamp less the recorded one, radians.
    ClampAngle,
    /// How far the point to which the moment refers is from the clamp, along the rod's direction there, m.
    LeverAlong,
    /// The same across, m.
    LeverAcross,
    /// Relative error of the bending stiffness: true over given, less 1.
    Stiffness,
    /// Relative error of the rod's length.
    Length,
    /// Natural curvature of the rod, times its length.
    NaturalCurvature,
    /// Compliance of the clamp against rotation, times EI/L.
    ClampCompliance,
    /// How far the clamp has moved on between the time of the reactions and that of the pose, m.
    Lag,
    /// Relative error of the stage's scale.
    StageScale,
    /// Coefficient of Coulomb friction at the contacts: positive where friction draws the rod from its clamp towards its tip, as on a rod that
    /// is drawn back, negative the other way.
    Friction,
}

impl Source {
    /// All sources, in the order of their numbers.
    pub const ALL: [Self; SOURCES] = [
        Self::BiasF0x,
        Self::BiasF0y,
        Self::BiasM0z,
        Self::DriftF0x,
        Self::DriftF0y,
        Self::DriftM0z,
        Self::BowF0x,
        Self::BowF0y,
        Self::BowM0z,
        Self::GainF0x,
        Self::GainF0y,
        Self::GainM0z,
        Self::F0yInF0x,
        Self::M0zInF0x,
        Self::F0xInF0y,
        Self::M0zInF0y,
        Self::F0xInM0z,
        Self::F0yInM0z,
        Self::ClampAngle,
        Self::LeverAlong,
        Self::LeverAcross,
        Self::Stiffness,
        Self::Length,
        Self::NaturalCurvature,
        Self::ClampCompliance,
        Self::Lag,
        Self::StageScale,
        Self::Friction,
    ];

    /// Its name in words and its unit; the unit is empty where it is a relative number.
    pub fn name(self) -> (&'static str, &'static str) {
        match self {
            Self::BiasF0x => ("bias of f0x", "N"),
            Self::BiasF0y => ("bias of f0y", "N"),
            Self::BiasM0z => ("bias of m0z", "N m"),
            Self::DriftF0x => ("drift of f0x", "N"),
            Self::DriftF0y => ("drift of f0y", "N"),
            Self::DriftM0z => ("drift of m0z", "N m"),
            Self::BowF0x => ("curved drift of f0x", "N"),
            Self::BowF0y => ("curved drift of f0y", "N"),
            Self::BowM0z => ("curved drift of m0z", "N m"),
            Self::GainF0x => ("gain of f0x", ""),
            Self::GainF0y => ("gain of f0y", ""),
            Self::GainM0z => ("gain of m0z", ""),
            Self::F0yInF0x => ("cross-talk of f0y to f0x", ""),
            Self::M0zInF0x => ("cross-talk of m0z to f0x", ""),
            Self::F0xInF0y => ("cross-talk of f0x to f0y", ""),
            Self::M0zInF0y => ("cross-talk of m0z to f0y", ""),
            Self::F0xInM0z => ("cross-talk of f0x to m0z", ""),
            Self::F0yInM0z => ("cross-talk of f0y to m0z", ""),
            Self::ClampAngle => ("clamp angle", "rad"),
            Self::LeverAlong => ("lever arm along the rod", "m"),
            Self::LeverAcross => ("lever arm across the rod", "m"),
            Self::Stiffness => ("bending stiffness", ""),
            Self::Length => ("length of the rod", ""),
            Self::NaturalCurvature => ("natural curvature times length", ""),
            Self::ClampCompliance => ("compliance of the clamp times EI/L", ""),
            Self::Lag => ("lag of the pose", "m"),
            Self::StageScale => ("scale of the stage", ""),
            Self::Friction => ("friction", ""),
        }
    }

    /// Whether each scan has its own, as bias and drift, and friction, whose direction is that of the scan. All others stay the same as long
    /// as rod, sensor, clamp and stage do.
    pub fn is_of_scan(self) -> bool {
        self <= Self::BowM0z || self == Self::Friction
    }

    /// What one dimensionless unit of it is, SI.
    pub(crate) fn unit(self, rod: &Rod) -> f64 {
        let units = rod.units();
        match self.name().1 {
            "N" => units.force,
            "N m" => units.moment,
            "m" => units.length,
            _ => 1.0,
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name().0)
    }
}
