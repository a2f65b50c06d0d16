//! A sensor that is simulated.

use rod_core::{Pose, Reactions};
use rod_hw::{Channels, Mounting, OutOfPlane, Quality, Rails, RawSample, Wrench};
use std::array::from_fn;
use std::convert::Infallible;

/// How a sensor turns a wrench into counts: so many per N and N m on each axis, in whole numbers, of so many bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counts {
    per_unit: [f64; 6],
    bits: u32,
    rails: Rails,
}

impl Counts {
    /// Counts per unit (N, N m) of each axis, and the bits of a count with its sign, 2 to 53.
    pub fn per_axis(per_unit: [f64; 6], bits: u32) -> Option<Self> {
        Some(Self { per_unit, bits, rails: Rails::of_bits(bits, 6)? })
    }

    /// Counts of a wrench, as many as there are bits for.
    pub fn channels(&self, wrench: &Wrench) -> Channels {
        let half = (1_u64 << (self.bits - 1)) as f64;
        let components = wrench.components();
        Channels::from(from_fn::<f64, 6, _>(|i| (components[i] * self.per_unit[i]).round().clamp(-half, half - 1.0)))
    }

    /// One count of each axis, N and N m.
    pub fn quantum(&self) -> Wrench {
        Wrench::from_components(self.per_unit.map(|counts| 1.0 / counts))
    }

    /// The ends of their range.
    pub fn rails(&self) -> Rails {
        self.rails
    }
}

/// A sensor that is simulated, as a source of raw samples: from states of the clamp (time in s, pose, reactions) through noise
/// and the mounting, backwards, to counts.
///
/// The noise is a closure that returns what the sensor feels of the true reactions, or none where the sample is lost; the
/// generator of `rod_reconstruct::NoiseModel` fits, `|clean| generator.sample(clean)`, and `Some` is none at all. Samples are numbered, lost ones
/// included.
#[derive(Clone, Debug)]
pub struct SimulatedSensor<I, F> {
    states: I,
    noise: F,
    mounting: Mounting,
    counts: Counts,
    number: u64,
}

impl<I, F> SimulatedSensor<I, F> {
    /// A sensor in these states, with this noise, mounted like that and counting like that.
    pub fn new(states: I, noise: F, mounting: Mounting, counts: Counts) -> Self {
        Self { states, noise, mounting, counts, number: 0 }
    }
}

impl<I, F> Iterator for SimulatedSensor<I, F>
where
    I: Iterator<Item = (f64, Pose, Reactions)>,
    F: FnMut(Reactions) -> Option<Reactions>,
{
    type Item = Result<RawSample, Infallible>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut quality = Quality::empty();
        loop {
            let (t, pose, clean) = self.states.next()?;
            let sequence = self.number;
            self.number += 1;
            let Some(felt) = (self.noise)(clean) else {
                quality = Quality::GAP_BEFORE;
                continue;
            };
            let wrench = self.mounting.wrench(&felt, &OutOfPlane::default(), pose);
            let channels = self.counts.channels(&wrench);
            return Some(Ok(RawSample { sequence: Some(sequence), quality, ..RawSample::new(t, channels) }));
        }
    }
}
