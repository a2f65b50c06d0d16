//! The contour, and the errors that all samples share, that explain a whole recording.
//!
//! Least squares on the forward model: the states of the rod past a free-form contour ([`rod_contact`]) at the poses of the recording are
//! compared with its reactions. A recording is cut at the jumps that it shows, and each segment is followed from an equilibrium of its own
//! (multiple shooting, Bock and Plitt 1984), so that a snap of the model at another pose than that of the recording spoils nothing beyond
//! it. Inside a segment contacts form and let go as the model says: labels of the local answer are where the fit starts, no more.

mod blocks;
mod curve;
mod forward;
mod outline;
mod problem;
mod solve;
mod start;
#[cfg(test)]
mod tests;
mod verdict;

pub use verdict::{Goodness, WorstWindow};

use crate::phase::Label;
use crate::pipeline::Reconstruction;
use crate::systematic::Source;
use blocks::Blocks;
use problem::Sources;
use rod_core::{PhysicalRod, Rod, Sample};
use solve::Recorded;
use start::{fill_with_singles, touched};
use std::ops::Range;

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The local answer has no contact point.
    #[error("no contact point is known from which a fit could start")]
    NoContacts,
    /// With friction the states of a rod depend on the whole way of the clamp.
    #[error("recordings with friction cannot be fitted")]
    Friction,
    /// The contact points give no curve that the fit could change.
    #[error("the contact points are in no order that gives a contour to start from")]
    NoStart,
}

/// A block of samples against the fit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedBlock {
    /// The samples from the first to after the last.
    pub samples: Range<usize>,
    /// The phase of the model; none where it is not reached.
    pub label: Option<Label>,
    /// Measured less model for f0x, f0y, m0z, in standard deviations of the mean of the block; none where it is left out (beside a jump) or
    /// not reached.
    pub residuals: Option<[f64; 3]>,
}

/// The contour that explains a recording best, and how well it does.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContourFit {
    /// Points of a cubic spline with natural ends, in the direction of contours, m.
    pub contour: Vec<[f64; 2]>,
    /// Standard deviations of these across the contour, m.
    pub sigmas: Vec<f64>,
    /// The errors that all samples share, in the units of the sources, with their standard deviations; empty where they are not estimated.
    pub errors: Vec<(Source, f64, f64)>,
    /// How well it explains the recording.
    pub goodness: Goodness,
    /// The recording in blocks.
    pub blocks: Vec<FittedBlock>,
}

impl ContourFit {
    /// Samples along which the model has one phase, in order; none where it is not reached.
    pub fn runs(&self) -> Vec<(Range<usize>, Option<Label>)> {
        let mut runs: Vec<(Range<usize>, Option<Label>)> = Vec::new();
        for block in &self.blocks {
            match runs.last_mut().filter(|run| run.1 == block.label) {
                Some(run) => run.0.end = block.samples.end,
                None => runs.push((block.samples.clone(), block.label)),
            }
        }
        runs
    }
}

/// Fits contour and shared errors to the `samples` of a recording, from its local answers `local` on. Of a rod that is not uniform no errors
/// are estimated, and of a uniform one none of its natural curvature.
///
/// First the fit starts from the contact points that are answered; where that does not explain the recording, also from those that single
/// contacts would have wherever there is no answer. A start that explains the recording wins, else the one of lower cost.
///
/// # Errors
/// [`FitError`].
pub fn fit_contour<R: PhysicalRod>(
    rod: &R,
    samples: &[Sample],
    local: &Reconstruction,
) -> Result<ContourFit, FitError> {
    if local.passes.iter().any(|pass| pass.used_friction != 0.0) {
        return Err(FitError::Friction);
    }
    let units = rod.units();
    let uniform = Rod::new(units.length, units.moment * units.length).map_err(|_| FitError::NoStart)?;
    let answered = Blocks::of(&uniform, samples, local).ok_or(FitError::NoContacts)?;
    let (sources, errors) = Sources::of(&uniform, local);
    let recorded = Recorded { rod, sources: &sources, errors: &errors };
    let mut points = touched(local, &uniform);
    let found = recorded.fitted(&answered, &points, true);
    if found.as_ref().is_ok_and(|solved| solved.goodness.explains) {
        return found.map(|solved| solved.result(&answered, &sources, &uniform));
    }
    let mut singles = answered.clone();
    points.extend(fill_with_singles(rod, &mut singles, &sources.errors(&errors)));
    let other = recorded.fitted(&singles, &points, false);
    let is_other_better = match (&found, &other) {
        (Ok(found), Ok(other)) => other.goodness.explains || other.cost < found.cost,
        (found, other) => found.is_err() && other.is_ok(),
    };
    let (best, blocks) = if is_other_better { (other, &singles) } else { (found, &answered) };
    best.map(|solved| solved.result(blocks, &sources, &uniform))
}
