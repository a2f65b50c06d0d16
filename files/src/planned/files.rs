//! The files of a plan.

use super::Planned;
use crate::output::{pretty_json, write_csv};
use crate::{OutputError, Staged};
use serde::Serialize;
use vibrissa::Pose;
use vibrissa::plan::{Forecast, Gain, StraightScan};

/// Columns of candidates.csv.
const CANDIDATES: [&str; 19] = [
    "candidate",
    "chosen",
    "angle",
    "distance",
    "pass",
    "x_from",
    "y_from",
    "x_to",
    "y_to",
    "gain",
    "gain_sigma",
    "touched",
    "time",
    "largest_moment",
    "largest_stress",
    "blocked",
    "swept",
    "sigma",
    "known_sigma_after",
];

/// A candidate scan, as a row of candidates.csv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedScan {
    /// Its number, from 0.
    pub candidate: usize,
    /// Its place among those that are taken, from 1.
    pub chosen: Option<usize>,
    /// Where it stands in a grid; none where its path was given.
    pub scan: Option<StraightScan>,
    /// First pose of the clamp.
    pub from: Pose,
    /// Last pose of the clamp.
    pub to: Pose,
    /// Length of the contour that it adds; none where it is ruled out.
    pub gain: Option<Gain>,
    /// s
    pub time: f64,
    /// Largest moment at the clamp, N m.
    pub largest_moment: f64,
    /// Largest bending stress, Pa; none where the diameter of the rod is not known.
    pub largest_stress: Option<f64>,
    /// Whether the clamp runs into the object in a hypothesis.
    pub is_blocked: bool,
    /// Hypotheses that were swept: all, or those up to the one that rules it out.
    pub swept: usize,
    /// Median of the predicted standard deviations, m; none without noise.
    pub sigma: Option<f64>,
    /// Median standard deviation at the points touched before, with this scan, m; none without noise.
    pub known_sigma_after: Option<f64>,
}

impl PlannedScan {
    /// The fields of [`CANDIDATES`].
    fn columns(&self) -> impl Serialize + use<> {
        let (scan, from, to) = (self.scan, self.from, self.to);
        // a tuple has sixteen members at most
        (
            (
                self.candidate,
                self.chosen,
                from.phi,
                scan.map(|scan| scan.distance),
                scan.map(|scan| scan.pass.to_string()),
            ),
            (from.x, from.y, to.x, to.y),
            (self.gain.map(|gain| gain.mean), self.gain.map(|gain| gain.sigma), self.gain.map(|gain| gain.touched)),
            (self.time, self.largest_moment, self.largest_stress, self.is_blocked, self.swept),
            (self.sigma, self.known_sigma_after),
        )
    }
}

/// plan.json.
#[derive(Serialize)]
struct PlanRecord {
    version: &'static str,
    hypotheses: usize,
    candidates: usize,
    /// Least share of the best value of as many candidates that the chosen ones have.
    bound: f64,
    /// Median standard deviation of the points touched before, m.
    known_sigma: Option<f64>,
    /// Largest bending stress of the chosen scans, Pa; none for any.
    stress_limit: Option<f64>,
    chosen: Vec<ChosenRecord>,
}

#[derive(Serialize)]
struct ChosenRecord {
    candidate: usize,
    from: Pose3,
    to: Pose3,
    /// Expected length of the contour that it adds to those before it, and of all so far, m.
    gain: f64,
    value: f64,
    /// Pa
    largest_stress: Option<f64>,
}

pub(super) type Pose3 = [f64; 3];

pub(super) fn pose(Pose { x, y, phi }: Pose) -> Pose3 {
    [x, y, phi]
}

impl Planned {
    /// Writes candidates.csv, the most promising first, and plan.json into the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        staged.write("candidates.csv".as_ref(), |file| {
            write_csv(file, &CANDIDATES, self.rows().iter().map(PlannedScan::columns))
        })?;
        staged.write("plan.json".as_ref(), |file| pretty_json(file, &self.record()))
    }

    /// The candidates, the largest gain first.
    pub fn rows(&self) -> Vec<PlannedScan> {
        self.ranked().into_iter().map(|(number, forecast)| self.row(number, forecast)).collect()
    }

    fn row(&self, candidate: usize, forecast: &Forecast) -> PlannedScan {
        let [from, to] = forecast.candidate.ends();
        PlannedScan {
            candidate,
            chosen: self.choices.iter().position(|choice| choice.candidate == candidate).map(|place| place + 1),
            scan: forecast.candidate.scan,
            from,
            to,
            gain: forecast.gain,
            time: forecast.time,
            largest_moment: forecast.largest_moment,
            largest_stress: forecast.largest_stress,
            is_blocked: forecast.is_blocked,
            swept: forecast.swept,
            sigma: median_sigma(forecast),
            known_sigma_after: forecast.known_sigma().map(|sigma| sigma[1]),
        }
    }

    fn record(&self) -> PlanRecord {
        let chosen = self.choices.iter().map(|choice| {
            let forecast = &self.plan.forecasts[choice.candidate];
            let [from, to] = forecast.candidate.ends().map(pose);
            let (candidate, largest_stress) = (choice.candidate, forecast.largest_stress);
            ChosenRecord { candidate, from, to, gain: choice.gain, value: choice.value, largest_stress }
        });
        let count = self.choices.len().max(1) as f64;
        PlanRecord {
            version: env!("CARGO_PKG_VERSION"),
            hypotheses: self.plan.hypotheses.len(),
            candidates: self.candidates,
            bound: 1.0 - (1.0 - 1.0 / count).powf(count),
            known_sigma: self.plan.forecasts.iter().find_map(Forecast::known_sigma).map(|sigma| sigma[0]),
            stress_limit: self.most_stress,
            chosen: chosen.collect(),
        }
    }
}

/// Median of the predicted standard deviations, m.
pub(super) fn median_sigma(forecast: &Forecast) -> Option<f64> {
    let mut sigmas: Vec<f64> = forecast.sigmas.iter().map(|one| one.sigma).collect();
    sigmas.sort_by(f64::total_cmp);
    sigmas.get(sigmas.len() / 2).copied()
}
