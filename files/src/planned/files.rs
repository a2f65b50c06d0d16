//! The files of a plan.

use super::Planned;
use crate::output::{pretty_json, write_csv};
use crate::{OutputError, Staged};
use serde::Serialize;
use vibrissa::Pose;
use vibrissa::plan::Forecast;

/// Columns of candidates.csv.
const CANDIDATES: [&str; 18] = [
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
    "sigma",
    "known_sigma_after",
];

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
}

type Pose3 = [f64; 3];

fn pose(Pose { x, y, phi }: Pose) -> Pose3 {
    [x, y, phi]
}

impl Planned {
    /// Writes candidates.csv, the most promising first, and plan.json into the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        staged.write("candidates.csv".as_ref(), |file| {
            write_csv(file, &CANDIDATES, self.ranked().into_iter().map(|(number, forecast)| self.row(number, forecast)))
        })?;
        staged.write("plan.json".as_ref(), |file| pretty_json(file, &self.record()))
    }

    fn row(&self, number: usize, forecast: &Forecast) -> impl Serialize + use<> {
        let chosen = self.choices.iter().position(|choice| choice.candidate == number).map(|place| place + 1);
        let path = forecast.candidate.path;
        let [from, to] = [path.at(0.0), path.at(path.length())];
        let scan = forecast.candidate.scan;
        // a tuple has sixteen members at most
        (
            (number, chosen, from.phi, scan.map(|scan| scan.distance), scan.map(|scan| scan.pass.to_string())),
            (from.x, from.y, to.x, to.y),
            (forecast.gain, forecast.gain_sigma, forecast.touched, forecast.time),
            (forecast.largest_moment, forecast.largest_stress, forecast.blocked),
            (median_sigma(forecast), forecast.known_sigma.map(|sigma| sigma[1])),
        )
    }

    fn record(&self) -> PlanRecord {
        let chosen = self.choices.iter().map(|choice| {
            let path = self.plan.forecasts[choice.candidate].candidate.path;
            ChosenRecord {
                candidate: choice.candidate,
                from: pose(path.at(0.0)),
                to: pose(path.at(path.length())),
                gain: choice.gain,
                value: choice.value,
            }
        });
        let count = self.choices.len().max(1) as f64;
        PlanRecord {
            version: env!("CARGO_PKG_VERSION"),
            hypotheses: self.plan.hypotheses.len(),
            candidates: self.candidates,
            bound: 1.0 - (1.0 - 1.0 / count).powf(count),
            known_sigma: self.plan.forecasts.iter().find_map(|forecast| forecast.known_sigma).map(|sigma| sigma[0]),
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
