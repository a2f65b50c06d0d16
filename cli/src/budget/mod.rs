//! What accuracy to expect of a scene: the errors that all samples share, through the reconstruction.
//!
//! `truth` is the scene as a perfect sensor records it. `forecast` says by derivatives how far each source of error displaces contact
//! points, before and after a scan calibrates itself, and `needed` scales that to another sensor. `trials` draws errors, puts them on the
//! samples and reconstructs. `files` writes the results, `report` tells them. `rods` compares rods
//! by the noise alone.

mod files;
mod forecast;
mod needed;
mod report;
mod rods;
mod study;
mod trials;
mod truth;

pub(crate) use forecast::Forecast;
pub use rods::{ComparedRods, RodComparison};
pub use study::{BudgetStudy, Expected};

use rod_files::{SceneError, SimulationError};
use vibrissa::reconstruct::{NoiseError, ReconstructError};

/// Why no accuracy can be told.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum BudgetError {
    /// The sweep has no single contact.
    #[error(
        "{scene}: no sample of the sweep has a single contact, expected some: the forecast is of their contact points"
    )]
    NoContact {
        /// Name of the scene.
        scene: String,
    },
    /// The simulated recording cannot be reconstructed at all.
    #[error("{scene}: the simulated recording cannot be reconstructed: {source}; raise --rate or lower --speed")]
    Reconstruct {
        /// Name of the scene.
        scene: String,
        /// Why.
        source: ReconstructError,
    },
    /// The rod is not uniform, not straight at rest or not on a rigid clamp.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The recording cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The noise model is not possible.
    #[error(transparent)]
    Noise(#[from] NoiseError),
}
