//! Reactions at the clamp.

use super::quality::Quality;
use super::raw::RawSample;
use rod_core::{Pose, Reactions, Sample};

/// Clamp pose and reactions at one instant, as the reconstruction takes them, and how far they can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReactionSample<T = f64> {
    /// Time, s.
    pub t: f64,
    /// The clamp: m, m, rad.
    pub pose: Pose<T>,
    /// Reactions of the clamp on the rod, N, N, N m about the clamp.
    pub reactions: Reactions<T>,
    /// Standard deviations of the random error, where they are known.
    pub sigma: Option<Reactions<T>>,
    /// Bounds of the systematic error, where they are known.
    pub systematic: Option<Reactions<T>>,
    /// What a planar rod cannot cause.
    pub out_of_plane: OutOfPlane<T>,
    /// Quality flags.
    pub quality: Quality,
    /// The raw sample.
    pub raw: RawSample,
}

/// The components that a rod bent in the plane does not cause, in the axes of the scene, about the clamp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutOfPlane<T = f64> {
    /// Force across the plane, N.
    pub f0z: T,
    /// Moment about x, N m.
    pub m0x: T,
    /// Moment about y, N m.
    pub m0y: T,
}

impl ReactionSample {
    /// For the reconstruction.
    pub fn sample(&self) -> Sample {
        Sample { t: Some(self.t), pose: self.pose, reactions: self.reactions, sigma: self.sigma }
    }
}
