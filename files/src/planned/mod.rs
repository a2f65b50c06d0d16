//! Which scans to make next: what `vibrissa plan` writes.

mod approaches;
mod files;
mod known;
mod report;
mod stress;

pub use approaches::Approaches;
pub use files::PlannedScan;
pub use known::read_known_contours;
pub use stress::LargestStress;

use crate::Interrupt;
use std::io;
use std::path::PathBuf;
use vibrissa::plan::{
    Candidate, Choice, ExploreError, Forecast, Measurement, Plan, PlanError, PlanSettings, ReachGrid, StraightScan,
    candidates, plan, straight_candidates,
};
use vibrissa::reconstruct::{FittedObject, NoiseModel};
use vibrissa::rod::AnyRod;

/// Distances that are tried unless others are given, in rod lengths.
const DISTANCES: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];

/// Angles that are tried unless others are given: all around.
const ANGLES: usize = 24;

/// A direction (rad) in degrees, from 0 to less than 360 as it is printed with two digits.
fn direction_degrees(angle: f64) -> f64 {
    // a remainder of nothing may be -0
    0.0 + ((100.0 * angle.to_degrees()).round() / 100.0).rem_euclid(360.0)
}

/// Why a plan cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanFileError {
    /// The directory has no fitted contour.
    #[error("cannot read {}: {source}; expected a directory of `vibrissa reconstruct` with a fitted contour", file.display())]
    NoFit {
        /// Its fitted.csv.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The table of the contour is none.
    #[error("{}: {reason}", file.display())]
    Table {
        /// Which file.
        file: PathBuf,
        /// Why, with line, field, value and expectation.
        reason: String,
    },
    /// How far the rod may bend is not known.
    #[error(
        "the largest stress that the rod bears is not known, expected the yield_stress of its material with the rod, or stress (Pa), which may be any"
    )]
    NoStress,
    /// How far the rod bends is not known.
    #[error("stress is given for a rod without a diameter, expected one with a diameter, or no stress")]
    NoDiameter,
    /// A rod with which an object cannot be approached.
    #[error(
        "a box is given for a rod that is not uniform, is bent at rest or has no rigid clamp, expected a uniform, straight, rigidly clamped rod"
    )]
    NotUniform,
    /// The scans.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The scans of an object of which only a box is known.
    #[error(transparent)]
    Explore(#[from] ExploreError),
}

/// What is asked of a plan.
#[derive(Clone, Debug)]
pub struct PlanRequest {
    /// Distances of the clamp's path from the object, m; none for the usual ones.
    pub distances: Option<Vec<f64>>,
    /// Directions of the rod at its clamp, rad; none for all around.
    pub angles: Option<Vec<f64>>,
    /// Further straight scans.
    pub scans: Vec<StraightScan>,
    /// Scans along further paths.
    pub paths: Vec<Candidate>,
    /// Noise of the sensor; none where no standard deviations are to be predicted.
    pub noise: Option<NoiseModel>,
    /// Samples in a second, Hz.
    pub rate: f64,
    /// Speed of the clamp, m/s.
    pub speed: f64,
    /// Most scans to take.
    pub count: usize,
    /// Largest bending stress that the rod bears.
    pub largest_stress: LargestStress,
    /// Objects that are drawn.
    pub hypotheses: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// Scans to make next, and what they are expected to bring.
#[derive(Clone, Debug)]
pub struct Planned {
    /// What it is called.
    pub name: String,
    /// What is known.
    pub known: Vec<FittedObject>,
    /// How many candidates there are: those of the request first, its scans before its paths.
    pub candidates: usize,
    /// Largest bending stress of the scans that are taken, Pa; none for any.
    pub most_stress: Option<f64>,
    /// All candidates.
    pub plan: Plan,
    /// Those that are taken, in order.
    pub choices: Vec<Choice>,
}

impl Planned {
    /// Judges straight scans, and those of the request, by what a reconstruction knows. Interrupted, fewer are judged.
    ///
    /// # Errors
    /// [`PlanFileError`].
    pub fn new(
        name: &str,
        rod: &AnyRod,
        known: Vec<FittedObject>,
        request: &PlanRequest,
        interrupt: &Interrupt,
    ) -> Result<Self, PlanFileError> {
        let most_stress = request.largest_stress.limit(rod)?;
        let length = rod.units().length;
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / ANGLES as f64;
        let grid = ReachGrid {
            distances: request.distances.clone().unwrap_or_else(|| DISTANCES.map(|share| share * length).to_vec()),
            angles: request.angles.clone().unwrap_or_else(|| (0..ANGLES).map(angle).collect()),
            ..ReachGrid::of(rod)
        };
        let settings = PlanSettings {
            hypotheses: request.hypotheses,
            seed: request.seed,
            speed: request.speed,
            most_stress,
            measurement: request
                .noise
                .as_ref()
                .map(|noise| Measurement::of(&noise.channels(), request.speed / request.rate, &known, length)),
        };
        let goes_on = || !interrupt.is_raised();
        let mut candidates = candidates(rod, &known, request.scans.iter().copied(), &settings, &goes_on)?;
        candidates.extend(request.paths.iter().cloned());
        candidates.extend(straight_candidates(rod, &known, &grid, &settings, &goes_on)?);
        let plan = plan(rod, &known, &candidates, &settings, &|done| {
            interrupt.pass(done as f64 / candidates.len() as f64);
            goes_on()
        })?;
        let choices = plan.greedy(request.count);
        Ok(Self { name: name.to_owned(), known, candidates: candidates.len(), most_stress, plan, choices })
    }

    /// The candidates, best gain first; those that are ruled out are the last.
    pub fn ranked(&self) -> Vec<(usize, &Forecast)> {
        let mut ranked: Vec<(usize, &Forecast)> = self.plan.forecasts.iter().enumerate().collect();
        let gain = |forecast: &Forecast| forecast.gain.map_or(f64::NEG_INFINITY, |gain| gain.mean);
        ranked.sort_by(|one, other| gain(other.1).total_cmp(&gain(one.1)));
        ranked
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_turn_is_printed_as_none() {
        let shown = |degrees: f64| format!("{:.2}", direction_degrees(degrees.to_radians()));
        assert_eq!([360.0, -1e-9, 390.0, 359.999, -90.0].map(shown), ["0.00", "0.00", "30.00", "0.00", "270.00"]);
    }
}
