//! Why an exploration cannot go on.

use crate::PlanError;
use rod_reconstruct::ReconstructError;

/// Why an exploration cannot go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExploreError {
    /// The rod has no yield stress, or no diameter.
    #[error(
        "the largest stress of the rod is not known, expected a rod with a diameter and a yield stress, or `largest_stress`"
    )]
    NoStress,
    /// A rectangle that is none.
    #[error(
        "{what} is {low:?} to {high:?} m, expected finite corners, the first one below and to the left of the second"
    )]
    Rectangle {
        /// `object` or `stage`.
        what: &'static str,
        /// As given, m.
        low: [f64; 2],
        /// As given, m.
        high: [f64; 2],
    },
    /// A number that must be positive.
    #[error("{what} is {value} {unit}, expected a positive, finite number")]
    NotPositive {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A recording without a proposal.
    #[error("a recording came though no scan was proposed, expected one for each proposal")]
    NotProposed,
    /// A recording that does not begin where the proposed path does.
    #[error(
        "the recording begins at ({x} m, {y} m), expected the start of the proposed path, ({from_x} m, {from_y} m)"
    )]
    Elsewhere {
        /// m
        x: f64,
        /// m
        y: f64,
        /// m
        from_x: f64,
        /// m
        from_y: f64,
    },
    /// Scans that cannot be.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The recording cannot be reconstructed.
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
}
