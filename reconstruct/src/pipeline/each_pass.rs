//! The reconstruction of a recording whose clamp turns back.

use super::reconstruct::reconstruct;
use super::reconstruction::Reconstruction;
use super::settings::{ReconstructError, Settings};
use crate::scan::passes;
use rod_core::{Rod, Sample};
use std::ops::Range;

/// [`reconstruct`] for each of the [`passes`] of a recording, with the samples of the pass. Numbers of samples in a result are
/// those within its pass.
pub fn reconstruct_passes(
    rod: &Rod,
    samples: &[Sample],
    settings: &Settings,
) -> Vec<(Range<usize>, Result<Reconstruction, ReconstructError>)> {
    let each = |pass: Range<usize>| (pass.clone(), reconstruct(rod, samples.get(pass).unwrap_or_default(), settings));
    passes(rod, samples).into_iter().map(each).collect()
}
