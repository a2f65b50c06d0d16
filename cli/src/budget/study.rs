//! A study of the accuracy that a scene allows.

use super::BudgetError;
use super::forecast::Forecast;
use super::needed::Needed;
use super::trials::{Trial, Trials};
use super::truth::PerfectSensor;
use rod_files::{Scene, SceneError, SceneFriction};
use vibrissa::contact::Stop;
use vibrissa::reconstruct::{Budget, Friction, Known, NoiseModel, reconstruct_passes};
use vibrissa::rod::{Reactions, Units};
use vibrissa::{Rod, Settings};

/// White noise of a sensor where none is stated, in E I / L^2 and E I / L: 0.5 mN and 0.02 mN m for a steel rod of 0.1 m and 0.5 mm.
const NOISE: [f64; 2] = [8e-3, 3e-3];

/// A scene, and how it is measured.
#[derive(Debug)]
pub struct BudgetStudy {
    /// What the clamp is led along. Its own step is not used.
    pub scene: Scene,
    /// How large the errors may be that all samples share: those of an ordinary laboratory if none is given.
    pub budget: Option<Budget>,
    /// The sensor: white noise of 0.008 E I / L^2 and 0.003 E I / L if none is given.
    pub noise: Option<NoiseModel>,
    /// Samples in a second, 1/s.
    pub rate: f64,
    /// Speed of the clamp: m/s, or rad/s where it only turns.
    pub speed: f64,
    /// What a reconstruction knows of friction: nothing of its coefficient if none is given and the scene has friction.
    pub friction: Option<Friction>,
    /// Number of recordings with random errors.
    pub runs: usize,
    /// Of errors and noise.
    pub seed: u64,
}

/// What to expect.
#[derive(Debug)]
pub struct Expected {
    /// The scene.
    pub scene: Scene,
    /// Samples of its sweep.
    pub samples: usize,
    /// Why the sweep stopped early.
    pub stop: Option<Stop>,
    /// The budget.
    pub budget: Budget,
    /// Standard deviation of the noise of a sample, N and N m.
    pub sigma: Reactions,
    pub(crate) forecast: Forecast,
    pub(super) needed: Option<Needed>,
    pub(super) runs: Vec<Trial>,
}

/// What may be done with another scene.
const INSTEAD: &str = "`budget` knows the errors of a uniform, straight rod on a rigid clamp alone: `vibrissa simulate --noise` and `vibrissa \
     reconstruct --truth` show what noise does to the contacts of any rod";

impl BudgetStudy {
    /// The rod of a scene, if its errors are known.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] where it is not uniform, not straight at rest or not on a rigid clamp.
    pub fn rod(scene: &Scene) -> Result<Rod, SceneError> {
        scene.uniform(INSTEAD)
    }

    /// Simulates, forecasts and tries.
    ///
    /// # Errors
    /// [`BudgetError`].
    pub fn run(self) -> Result<Expected, BudgetError> {
        let rod = Self::rod(&self.scene)?;
        let rubs = self.scene.friction.as_ref().is_some_and(SceneFriction::rubs);
        let friction = self.friction.unwrap_or(if rubs { Friction::Estimate } else { Friction::None });
        let errors = self.budget.unwrap_or_else(|| Budget::laboratory(&rod));
        let budget = Budget { friction: friction.sigma(), ..errors };
        let noise = self.noise.unwrap_or_else(|| usual(&rod));
        noise.check()?;
        let (truth, scene) = PerfectSensor::of(self.scene, self.rate, self.speed)?;
        let settings = Settings { budget: Some(errors), known: Known::NOTHING, friction, ..Settings::default() };
        let (read, _) = truth.read(&truth.samples, &noise, self.seed)?;
        let found = reconstruct_passes(&rod, &read, &settings)
            .map_err(|source| BudgetError::Reconstruct { scene: scene.name.clone(), source })?;
        let sigma = noise.sigma();
        let forecast = Forecast::of(&rod, &truth, &budget, sigma, &found)
            .ok_or_else(|| BudgetError::NoContact { scene: scene.name.clone() })?;
        let needed = Needed::of(&forecast);
        let trials =
            Trials { truth: &truth, scene: &scene, budget, noise: &noise, settings, seed: self.seed.wrapping_add(1) };
        let runs = trials.run(self.runs)?;
        let PerfectSensor { samples, stop, .. } = truth;
        Ok(Expected { samples: samples.len(), stop, budget, sigma, forecast, needed, runs, scene })
    }
}

/// The noise of a sensor that suits the rod.
fn usual(rod: &Rod) -> NoiseModel {
    let Units { force, moment, .. } = rod.units();
    let white = Reactions { f0x: NOISE[0] * force, f0y: NOISE[0] * force, m0z: NOISE[1] * moment };
    NoiseModel { white, ..NoiseModel::default() }
}
