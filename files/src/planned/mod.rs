//! Which scans to make next: what `vibrissa plan` writes.

mod files;
mod known;
mod report;

pub use known::read_known_contours;

use crate::Interrupt;
use std::io;
use std::path::PathBuf;
use vibrissa::plan::{
    Choice, Forecast, Known, KnownContour, Measurement, Plan, PlanError, PlanSettings, ReachGrid, plan,
    straight_candidates,
};
use vibrissa::reconstruct::NoiseModel;
use vibrissa::rod::AnyRod;

/// Distances that are tried unless others are given, in rod lengths.
const DISTANCES: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];

/// Angles that are tried unless others are given: all around.
const ANGLES: usize = 24;

/// The least change of curvature per root of way that a contour is expected to have, L^-1.5: of a nearly straight or round contour the fit determines
/// it from noise.
const LEAST_BEND: f64 = 1.0;

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
    /// The scans.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// What is asked of a plan.
#[derive(Clone, Debug)]
pub struct PlanRequest {
    /// Distances of the clamp's path from the object, m; none for the usual ones.
    pub distances: Option<Vec<f64>>,
    /// Directions of the rod at its clamp, rad; none for all around.
    pub angles: Option<Vec<f64>>,
    /// Noise of the sensor; none where no standard deviations are to be predicted.
    pub noise: Option<NoiseModel>,
    /// Samples in a second, Hz.
    pub rate: f64,
    /// Speed of the clamp, m/s.
    pub speed: f64,
    /// Most scans to take.
    pub count: usize,
    /// Largest bending stress that the rod bears, Pa.
    pub most_stress: Option<f64>,
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
    pub known: Vec<KnownContour>,
    /// How many candidates there are.
    pub candidates: usize,
    /// All candidates.
    pub plan: Plan,
    /// Those that are taken, in order.
    pub choices: Vec<Choice>,
}

impl Planned {
    /// Judges straight scans by what a reconstruction knows. Interrupted, fewer are judged.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn new(
        name: &str,
        rod: &AnyRod,
        known: Vec<KnownContour>,
        request: &PlanRequest,
        interrupt: &Interrupt,
    ) -> Result<Self, PlanError> {
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
            measurement: request.noise.as_ref().map(|noise| measurement(noise, request, &known, length)),
        };
        let candidates = straight_candidates(rod, &known, &grid, &settings)?;
        let plan = plan(rod, &known, &candidates, &settings, &|done| {
            interrupt.pass(done as f64 / candidates.len() as f64);
            !interrupt.is_raised()
        })?;
        let choices = plan.greedy(request.count, request.most_stress);
        Ok(Self { name: name.to_owned(), known, candidates: candidates.len(), plan, choices })
    }

    /// Whether all candidates were judged.
    pub fn is_complete(&self) -> bool {
        self.plan.forecasts.len() == self.candidates
    }

    /// The candidates, best gain first.
    pub fn ranked(&self) -> Vec<(usize, &Forecast)> {
        let mut ranked: Vec<(usize, &Forecast)> = self.plan.forecasts.iter().enumerate().collect();
        ranked.sort_by(|one, other| other.1.gain.total_cmp(&one.1.gain));
        ranked
    }
}

/// The sensor, with the resolution and the smoothness that the contour has now.
pub fn measurement(noise: &NoiseModel, request: &PlanRequest, known: &[KnownContour], length: f64) -> Measurement {
    let channels = noise.channels();
    let (mut ways, mut changes) = (Vec::new(), Vec::new());
    for contour in known {
        let is_touched = |k: usize| matches!(contour.known[k], Known::Touched { .. });
        let way = |k: usize| {
            let [from, to] = [contour.points[k], contour.points[k + 1]];
            (to[0] - from[0]).hypot(to[1] - from[1])
        };
        let turn = |k: usize| {
            let angle = |k: usize| {
                let [from, to] = [contour.points[k], contour.points[k + 1]];
                (to[1] - from[1]).atan2(to[0] - from[0])
            };
            let turn = angle(k) - angle(k - 1);
            turn.sin().atan2(turn.cos())
        };
        for k in 1..contour.points.len().saturating_sub(2) {
            if (k - 1..=k + 2).all(is_touched) && (k..=k + 1).all(|k| !contour.vertices.contains(&k)) {
                let curvature = |k: usize| 2.0 * turn(k) / (way(k - 1) + way(k));
                ways.push(way(k));
                changes.push((curvature(k + 1) - curvature(k)).powi(2) / way(k));
            }
        }
    }
    ways.sort_by(f64::total_cmp);
    let bend = (changes.iter().sum::<f64>() / changes.len().max(1) as f64).sqrt();
    Measurement {
        sigma: channels.each_ref().map(|channel| channel.sigma),
        long_run: channels.each_ref().map(|channel| channel.long_run),
        spacing: request.speed / request.rate,
        resolution: ways.get(ways.len() / 2).copied().unwrap_or(0.02 * length),
        bend: bend.max(LEAST_BEND * length.powf(-1.5)),
    }
}
