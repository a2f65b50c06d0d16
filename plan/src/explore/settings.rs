//! What an exploration is given.

use super::{ExploreError, Rectangle};
use rod_core::Rod;
use rod_reconstruct::Settings;
use rod_reconstruct::noise_estimate::ChannelNoise;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Angles, and distances in rod lengths, that are tried unless others are given.
const ANGLES: usize = 12;
const DISTANCES: [f64; 4] = [0.35, 0.5, 0.65, 0.8];

/// Where the rig can bring the clamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// The clamp stays in it, m.
    pub bounds: Rectangle,
}

/// What an exploration is given.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplorerSettings {
    /// The object is somewhere in it, m. All that is known at the start.
    pub object: Rectangle,
    /// Where the clamp may be; anywhere if none is given.
    pub stage: Option<Stage>,
    /// Directions of the rod at its clamp that are tried, rad.
    pub angles: Vec<f64>,
    /// Distances of the clamp's path from the object that are tried, m.
    pub distances: Vec<f64>,
    /// Largest bending stress that the rod bears, Pa.
    pub largest_stress: f64,
    /// Noise of f0x, f0y (N) and m0z (N m).
    pub noise: [ChannelNoise; 3],
    /// Way of the clamp from one sample to the next, m.
    pub spacing: f64,
    /// Speed of the clamp, m/s.
    pub speed: f64,
    /// How recordings are reconstructed. Its noise is replaced by `noise`.
    pub reconstruction: Settings,
    /// The contour is to be known with this standard deviation, m.
    pub sigma: f64,
    /// A scan is made only where it is expected to add so much, m: length of the contour that it newly touches, and length on which it brings the standard
    /// deviation below `sigma`.
    pub least_gain: f64,
    /// Most scans.
    pub most_scans: usize,
    /// Objects that are drawn, beside the most plausible one.
    pub hypotheses: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl ExplorerSettings {
    /// For an object in a rectangle and a sensor with this noise: 12 angles all around and distances of 0.35, 0.5, 0.65 and 0.8 rod lengths, the yield stress of the rod,
    /// a sample every 0.0005 rod lengths at 0.01 rod lengths a second, a standard deviation of 0.001 and a least gain of 0.02 rod lengths, 40 scans, 4 hypotheses.
    ///
    /// # Errors
    /// [`ExploreError::NoStress`] where the yield stress of the rod is not known.
    pub fn new(rod: &Rod, object: Rectangle, noise: [ChannelNoise; 3]) -> Result<Self, ExploreError> {
        let length = rod.length();
        let largest_stress = rod.yield_stress().ok_or(ExploreError::NoStress)?;
        Ok(Self {
            object,
            stage: None,
            angles: (0..ANGLES).map(|k| (FRAC_PI_2 + TAU * k as f64 / ANGLES as f64) % TAU).collect(),
            distances: DISTANCES.map(|share| share * length).to_vec(),
            largest_stress,
            noise,
            spacing: 5e-4 * length,
            speed: 1e-2 * length,
            reconstruction: Settings::default(),
            sigma: 1e-3 * length,
            least_gain: 2e-2 * length,
            most_scans: 40,
            hypotheses: 4,
            seed: 0,
        })
    }

    pub(super) fn check(&self, rod: &Rod) -> Result<(), ExploreError> {
        let rectangles = [("object", Some(self.object)), ("stage", self.stage.map(|stage| stage.bounds))];
        for (what, rectangle) in rectangles {
            if let Some(Rectangle { low, high }) = rectangle.filter(|rectangle| !rectangle.is_proper()) {
                return Err(ExploreError::Rectangle { what, low, high });
            }
        }
        let numbers = [
            ("largest_stress", self.largest_stress, "Pa"),
            ("spacing", self.spacing, "m"),
            ("speed", self.speed, "m/s"),
            ("sigma", self.sigma, "m"),
            ("least_gain", self.least_gain, "m"),
        ];
        if let Some((what, value, unit)) =
            numbers.into_iter().find(|(_, value, _)| !(value.is_finite() && *value > 0.0))
        {
            return Err(ExploreError::NotPositive { what, value, unit });
        }
        if rod.diameter().is_none() {
            return Err(ExploreError::NoStress);
        }
        Ok(())
    }
}
