//! The true samples of a scene.

use super::BudgetError;
use rod_files::{Scene, Simulation};
use vibrissa::contact::Stop;
use vibrissa::reconstruct::{NoiseError, NoiseModel};
use vibrissa::rod::Reactions;
use vibrissa::{Label, Sample};

/// What a perfect sensor records.
pub(super) struct PerfectSensor {
    pub samples: Vec<Sample>,
    pub labels: Vec<Label>,
    /// Numbers of the samples along the path: a snap leaves some out.
    numbers: Vec<usize>,
    /// Why the sweep stopped early.
    pub stop: Option<Stop>,
}

impl PerfectSensor {
    pub fn of(scene: Scene, rate: f64, speed: f64) -> Result<(Self, Scene), BudgetError> {
        let simulation = Simulation { scene, noise: NoiseModel::default(), rate, speed, seed: 0, sigmas: false };
        let mut truth = Self { samples: Vec::new(), labels: Vec::new(), numbers: Vec::new(), stop: None };
        for tick in simulation.ticks()? {
            match tick {
                Ok(tick) => {
                    truth.samples.push(Sample::new(tick.pose, tick.reactions.unwrap_or_default()));
                    truth.labels.push(tick.label);
                    truth.numbers.push(tick.number);
                }
                Err(stop) => truth.stop = Some(stop),
            }
        }
        Ok((truth, simulation.scene))
    }

    /// Samples as a sensor reads them, and their true labels; lost samples are left out.
    pub fn read(
        &self,
        samples: &[Sample],
        noise: &NoiseModel,
        seed: u64,
    ) -> Result<(Vec<Sample>, Vec<Label>), NoiseError> {
        let mut sensor = noise.generator(seed)?;
        let mut next = 0;
        let (mut read, mut labels) = (Vec::with_capacity(samples.len()), Vec::with_capacity(samples.len()));
        for ((sample, label), number) in samples.iter().zip(&self.labels).zip(&self.numbers) {
            // the sensor goes on where there is no sample
            for _ in next..*number {
                sensor.sample(Reactions::default());
            }
            next = number + 1;
            if let Some(reactions) = sensor.sample(sample.reactions) {
                read.push(Sample { reactions, ..*sample });
                labels.push(*label);
            }
        }
        Ok((read, labels))
    }
}
