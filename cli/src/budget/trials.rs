//! Recordings with random errors, reconstructed.

use super::BudgetError;
use super::forecast::median;
use super::truth::PerfectSensor;
use rayon::prelude::*;
use rod_files::Scene;
use serde::Serialize;
use vibrissa::reconstruct::score::signed_distance;
use vibrissa::reconstruct::{Budget, Friction, NoiseModel, Source, disturb, reconstruct_passes};
use vibrissa::rod::Reactions;
use vibrissa::{Label, Settings};

/// Standard deviations beyond which a contact point is wrong.
const FAR: f64 = 6.0;

/// What the recordings are made of.
pub(super) struct Trials<'a> {
    pub truth: &'a PerfectSensor,
    pub scene: &'a Scene,
    pub budget: Budget,
    pub noise: &'a NoiseModel,
    pub settings: Settings,
    pub seed: u64,
}

/// How well a recording was reconstructed. Distances are those of single contacts from the contour.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Trial {
    /// Share of samples with the right label.
    pub labels_right: f64,
    /// Contact points of samples labelled A or B.
    pub points: usize,
    /// m; none without points.
    pub median: Option<f64>,
    pub percentile_95: Option<f64>,
    /// Median of the standard deviations that the reconstruction states, m.
    pub stated: Option<f64>,
    /// Share of the points beyond six of their standard deviations.
    pub beyond_six_sigma: f64,
    /// Mean of the squares of distance over standard deviation: 1 where the standard deviations are right, on average over many runs.
    pub error_variance: Option<f64>,
}

impl Trials<'_> {
    /// So many recordings.
    pub fn run(&self, runs: usize) -> Result<Vec<Trial>, BudgetError> {
        (0..runs as u64).into_par_iter().map(|run| self.one(self.seed.wrapping_add(2 * run))).collect()
    }

    fn one(&self, seed: u64) -> Result<Trial, BudgetError> {
        // independent standard normal numbers
        let white = NoiseModel { white: Reactions { f0x: 1.0, f0y: 1.0, m0z: 1.0 }, ..NoiseModel::default() };
        let mut normal = white.generator(seed)?;
        let drawn: Vec<f64> = (0..Source::ALL.len().div_ceil(3))
            .flat_map(|_| {
                let Reactions { f0x, f0y, m0z } = normal.sample(Reactions::default()).unwrap_or_default();
                [f0x, f0y, m0z]
            })
            .collect();
        let error = |source: Source| drawn[source as usize] * self.budget.of(source);
        // a length or stiffness below 0: the budget is no small error
        let Ok((given, disturbed)) = disturb(self.scene.rod.at_clamp(), &self.truth.samples, error) else {
            return Ok(Trial::default());
        };
        let (read, labels) = self.truth.read(&disturbed, self.noise, seed.wrapping_add(1))?;
        // a coefficient that is known is so with an error, too
        let friction = match self.settings.friction {
            Friction::Known { mu, sigma } => Friction::Known { mu: (mu + error(Source::Friction)).abs(), sigma },
            other => other,
        };
        let settings = Settings { friction, ..self.settings };
        let Ok(found) = reconstruct_passes(&given, &read, &settings) else { return Ok(Trial::default()) };
        let right = found.readings.iter().zip(&labels).filter(|(reading, label)| reading.label == **label).count();
        let single = found.readings.iter().filter(|reading| matches!(reading.label, Label::A | Label::B));
        let judged: Vec<(f64, f64)> = single
            .filter_map(|reading| {
                let touch = reading.touch.ok()?;
                let off = signed_distance(&self.scene.objects, touch.x, touch.y)?.abs();
                Some((off, touch.sigma_normal()))
            })
            .collect();
        let mut distances: Vec<f64> = judged.iter().map(|one| one.0).collect();
        distances.sort_unstable_by(f64::total_cmp);
        let points = judged.len();
        let quantile = |share: f64| distances.get((share * points.saturating_sub(1) as f64).round() as usize).copied();
        let squares: f64 = judged.iter().map(|(off, sigma)| (off / sigma).powi(2)).sum();
        Ok(Trial {
            labels_right: right as f64 / labels.len().max(1) as f64,
            points,
            median: quantile(0.5),
            percentile_95: quantile(0.95),
            stated: median(judged.iter().map(|one| one.1)),
            beyond_six_sigma: judged.iter().filter(|(off, sigma)| *off > FAR * sigma).count() as f64
                / points.max(1) as f64,
            error_variance: (points > 0).then(|| squares / points as f64),
        })
    }
}
