//! The readings of a simulated sensor.

use super::model::{Ar1, Dropout, NoiseError, NoiseModel};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rod_core::Reactions;

/// Turns true reactions into the readings of a sensor with a [`NoiseModel`], sample by sample, without allocation.
#[derive(Clone, Debug)]
pub struct NoiseGenerator {
    // each part only where the model has one, because zero times infinity is not zero
    linear: Option<([[f64; 3]; 3], [f64; 3])>,
    white: Option<NormalDraws>,
    ar1: Option<Remembered>,
    walk: Option<Walk>,
    quantum: Option<[f64; 3]>,
    dropout: Option<Gaps>,
}

/// The streams of random numbers.
#[derive(Clone, Copy)]
enum Stream {
    White,
    Ar1,
    Walk,
    Dropout,
}

impl NoiseModel {
    /// A simulated sensor before its first sample. The same seed gives the same noise. Each part of the model has its own stream of
    /// random numbers, so that the noise of one part does not depend on the others.
    ///
    /// # Errors
    /// [`NoiseError`] of [`check`](Self::check).
    pub fn generator(&self, seed: u64) -> Result<NoiseGenerator, NoiseError> {
        self.check()?;
        Ok(NoiseGenerator::new(self, seed))
    }
}

impl NoiseGenerator {
    /// Of a model that has been checked.
    fn new(model: &NoiseModel, seed: u64) -> Self {
        let normal =
            |sigma: Reactions, stream| channels(sigma).map(|sigma| NormalDraws { sigma, random: random(seed, stream) });
        let Dropout { probability, .. } = model.dropout;
        Self {
            linear: linear(model),
            white: normal(model.white, Stream::White),
            ar1: normal(model.ar1.sigma, Stream::Ar1).map(|normal| Remembered::new(normal, &model.ar1)),
            walk: normal(model.random_walk, Stream::Walk).map(|steps| Walk { steps, at: None }),
            quantum: channels(model.quantum),
            dropout: (probability > 0.0).then(|| Gaps::new(&model.dropout, random(seed, Stream::Dropout))),
        }
    }

    /// The reading of the next sample; none where it is lost.
    pub fn sample(&mut self, clean: Reactions) -> Option<Reactions> {
        let mut r = [clean.f0x, clean.f0y, clean.m0z];
        if let Some((matrix, offset)) = &self.linear {
            r = std::array::from_fn(|i| {
                matrix[i].iter().zip(&r).map(|(entry, value)| entry * value).sum::<f64>() + offset[i]
            });
        }
        for noise in [
            self.white.as_mut().map(NormalDraws::draw),
            self.ar1.as_mut().map(Remembered::draw),
            self.walk.as_mut().map(Walk::draw),
        ]
        .into_iter()
        .flatten()
        {
            r = std::array::from_fn(|i| r[i] + noise[i]);
        }
        if let Some(quantum) = &self.quantum {
            r = std::array::from_fn(|i| if quantum[i] > 0.0 { (r[i] / quantum[i]).round() * quantum[i] } else { r[i] });
        }
        let [f0x, f0y, m0z] = r;
        let lost = self.dropout.as_mut().is_some_and(Gaps::next);
        (!lost).then_some(Reactions { f0x, f0y, m0z })
    }
}

/// The channels, if one of them is not zero.
fn channels(r: Reactions) -> Option<[f64; 3]> {
    let channels = [r.f0x, r.f0y, r.m0z];
    channels.iter().any(|channel| *channel != 0.0).then_some(channels)
}

fn linear(model: &NoiseModel) -> Option<([[f64; 3]; 3], [f64; 3])> {
    let gain = channels(model.gain);
    let crosstalk = Some(model.crosstalk).filter(|rows| rows.iter().flatten().any(|entry| *entry != 0.0));
    let offset = channels(model.offset);
    if gain.is_none() && crosstalk.is_none() && offset.is_none() {
        return None;
    }
    let mut matrix = crosstalk.unwrap_or_default();
    for (i, gain) in gain.unwrap_or_default().into_iter().enumerate() {
        matrix[i][i] += 1.0 + gain;
    }
    Some((matrix, offset.unwrap_or_default()))
}

fn random(seed: u64, stream: Stream) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream as u64);
    random
}

/// White noise.
#[derive(Clone, Debug)]
struct NormalDraws {
    sigma: [f64; 3],
    random: ChaCha8Rng,
}

impl NormalDraws {
    fn draw(&mut self) -> [f64; 3] {
        self.sigma.map(|sigma| sigma * self.random.sample::<f64, _>(StandardNormal))
    }
}

/// AR(1) noise.
#[derive(Clone, Debug)]
struct Remembered {
    normal: NormalDraws,
    correlation: f64,
    fresh: f64,
    last: Option<[f64; 3]>,
}

impl Remembered {
    fn new(normal: NormalDraws, model: &Ar1) -> Self {
        let correlation = model.correlation;
        let fresh = ((1.0 - correlation) * (1.0 + correlation)).sqrt();
        Self { normal, correlation, fresh, last: None }
    }

    fn draw(&mut self) -> [f64; 3] {
        let drawn = self.normal.draw();
        let next = match self.last {
            Some(last) => std::array::from_fn(|i| self.correlation * last[i] + self.fresh * drawn[i]),
            None => drawn,
        };
        self.last = Some(next);
        next
    }
}

/// A random walk from zero.
#[derive(Clone, Debug)]
struct Walk {
    steps: NormalDraws,
    at: Option<[f64; 3]>,
}

impl Walk {
    fn draw(&mut self) -> [f64; 3] {
        let next = match self.at {
            Some(at) => {
                let step = self.steps.draw();
                std::array::from_fn(|i| at[i] + step[i])
            }
            None => [0.0; 3],
        };
        self.at = Some(next);
        next
    }
}

/// Which samples are lost: a chain of two states.
#[derive(Clone, Debug)]
struct Gaps {
    random: ChaCha8Rng,
    /// Chance to be lost: of the first sample, after one that arrived, after one that was lost.
    first: f64,
    arrived: f64,
    lost: f64,
    last: Option<bool>,
}

impl Gaps {
    fn new(model: &Dropout, random: ChaCha8Rng) -> Self {
        let (arrived, lost) = model.chances();
        Self { random, first: model.probability, arrived, lost, last: None }
    }

    fn next(&mut self) -> bool {
        let chance = match self.last {
            None => self.first,
            Some(false) => self.arrived,
            Some(true) => self.lost,
        };
        let lost = self.random.random::<f64>() < chance;
        self.last = Some(lost);
        lost
    }
}
