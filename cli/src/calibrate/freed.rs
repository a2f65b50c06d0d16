//! Which sources of errors a calibration looks for.

use vibrissa::reconstruct::{Budget, Known, Source};

/// Sources that a calibration looks for together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Freed {
    /// Bending stiffness of the rod
    Stiffness,
    /// Length of the rod
    Length,
    /// Natural curvature of the rod
    NaturalCurvature,
    /// Gains of the three channels
    Gains,
    /// Cross-talk between the channels
    CrossTalk,
    /// Angle of the clamp
    Angle,
    /// Lever arm: where the point is to which the moment refers
    Lever,
    /// Compliance of the clamp against rotation
    Compliance,
    /// Lag of the poses
    Lag,
    /// Scale of the stage
    Stage,
}

impl Freed {
    /// What a source belongs to; none for bias and drift, which each scan has its own.
    pub(crate) fn of(source: Source) -> Option<Self> {
        Some(match source {
            Source::Stiffness => Self::Stiffness,
            Source::Length => Self::Length,
            Source::NaturalCurvature => Self::NaturalCurvature,
            Source::GainF0x | Source::GainF0y | Source::GainM0z => Self::Gains,
            Source::ClampAngle => Self::Angle,
            Source::LeverAlong | Source::LeverAcross => Self::Lever,
            Source::ClampCompliance => Self::Compliance,
            Source::Lag => Self::Lag,
            Source::StageScale => Self::Stage,
            source if source.is_of_scan() => return None,
            _ => Self::CrossTalk,
        })
    }
}

/// What is known before, where only some sources are looked for: the others keep their values, or 0.
pub(super) fn known_besides(known: &Known, budget: &Budget, free: &[Freed]) -> Known {
    let others = Source::ALL.into_iter().filter(|source| Freed::of(*source).is_some_and(|of| !free.contains(&of)));
    let held = others.fold(*known, |held, source| {
        let value = known.of(source).map_or(0.0, |known| known.0);
        held.with(source, value, 0.0)
    });
    // a source that is looked for has the larger of both deviations
    Source::ALL.into_iter().filter(|source| Freed::of(*source).is_some_and(|of| free.contains(&of))).fold(
        held,
        |held, source| match known.of(source) {
            Some((value, 0.0)) => held.with(source, value, budget.of(source)),
            _ => held,
        },
    )
}

/// What is known after a calibration, where only some sources were looked for: of the others, what was known before.
pub(super) fn with_held(found: Known, before: &Known, free: &[Freed]) -> Known {
    let held = |source: &Source| !free.is_empty() && Freed::of(*source).is_some_and(|of| !free.contains(&of));
    Source::ALL.into_iter().filter(held).fold(found, |known, source| match before.of(source) {
        Some((value, sigma)) => known.with(source, value, sigma),
        None => known,
    })
}
