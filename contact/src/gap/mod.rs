//! The gap between the whole rod and the objects: proven from below, or the places where the rod goes through.

mod interval;
pub(crate) mod passing;
mod prover;
pub(crate) mod scan;
mod separator;
pub(crate) mod shape;
mod touch;

pub(crate) use prover::{Proof, Prover};

use crate::scene::world::Foot;

/// Depth (L) that counts as a closed gap: the residual of a solve leaves so much.
pub(crate) const GAP_TOLERANCE: f64 = 1e-12;

/// The same at a located transition, where another contact may be about to form. Ten times this is proven there.
pub(crate) const AT_TRANSITION: f64 = 1e-10;

/// A place where the rod goes through the contour: a local minimum of the gap along the rod.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub stretch: usize,
    pub s: f64,
    pub phi: f64,
    pub foot: Foot,
    /// At the end of the rod, where the gap still falls.
    pub tip: bool,
}
