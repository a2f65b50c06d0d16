//! A sensor that is simulated.

use crate::mounting::Mounting;
use crate::quality::Quality;
use crate::raw::{Channels, RawSample};
use crate::reaction_sample::OutOfPlane;
use crate::saturation::Rails;
use crate::wrench::Wrench;
use core::array::from_fn;
use core::convert::Infallible;
use rod_core::{Pose, Reactions};

/// How a sensor turns a wrench into counts: so many per N and N m on each axis, in whole numbers, of so many bits.
///
/// ```
/// use rod_hw::{Counts, Wrench};
/// let counts = Counts::new(1e4, 1e6, 16)?;
/// let wrench = Wrench { force: [0.5, -9.0, 0.0], torque: [0.0, 0.0, 1.26e-5] };
/// // the second one is beyond 16 bits
/// assert_eq!(*counts.channels(&wrench), [5000.0, -32_768.0, 0.0, 0.0, 0.0, 13.0]);
/// assert_eq!(counts.quantum().torque, [1e-6; 3]);
/// # Ok::<(), rod_hw::CountsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counts {
    per_unit: [f64; 6],
    bits: u32,
    rails: Rails,
}

/// Why something is no way to count.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CountsError {
    /// A scale that is none.
    #[error("{value} counts per unit, expected a finite number above 0")]
    PerUnit {
        /// Its value.
        value: f64,
    },
    /// So many bits hold nothing, or no whole number exactly.
    #[error("counts of {bits} bits, expected 2 to 53")]
    Bits {
        /// How many.
        bits: u32,
    },
}

impl Counts {
    /// Counts per N, counts per N m, and the bits of a count with its sign.
    ///
    /// # Errors
    /// [`CountsError`].
    pub fn new(per_newton: f64, per_newton_metre: f64, bits: u32) -> Result<Self, CountsError> {
        let (f, m) = (per_newton, per_newton_metre);
        Self::per_axis([f, f, f, m, m, m], bits)
    }

    /// Counts per unit (N, N m) of each axis, and the bits of a count with its sign.
    ///
    /// # Errors
    /// [`CountsError`].
    pub fn per_axis(per_unit: [f64; 6], bits: u32) -> Result<Self, CountsError> {
        if let Some(&value) = per_unit.iter().find(|value| !value.is_finite() || **value <= 0.0) {
            return Err(CountsError::PerUnit { value });
        }
        let rails = Rails::of_bits(bits, 6).ok_or(CountsError::Bits { bits })?;
        Ok(Self { per_unit, bits, rails })
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
///
/// ```
/// use rod_core::{Pose, Reactions};
/// use rod_hw::{
///     Counts, FnStage, Frame, Mounting, Quality, Scale, SignalChain, SimulatedSensor, WrenchChain, WrenchUnits,
/// };
/// let states = (0..100_u32).map(|i| {
///     let t = 2e-3 * f64::from(i);
///     (t, Pose { x: -1e-3 * t, y: -0.04, phi: 1.571 }, Reactions { f0x: -0.2, f0y: 0.3 * t, m0z: 1e-2 * t })
/// });
/// // no noise, but one in ten samples is lost
/// let mut count = 0;
/// let noise = |clean: Reactions| {
///     count += 1;
///     (count % 10 != 0).then_some(clean)
/// };
/// let mounting = Mounting::new(Frame::planar(0.3)?.with_origin([0.0, 0.0, 0.04])?);
/// let sensor = SimulatedSensor::new(states, noise, mounting, Counts::new(1e4, 1e6, 24)?);
///
/// // and back
/// let calibration: Scale = Scale::from_counts_per_axis([1e4, 1e4, 1e4, 1e6, 1e6, 1e6], WrenchUnits::parse("N", "N m")?)?;
/// let stage = FnStage(|t: f64| Ok(Pose { x: -1e-3 * t, y: -0.04, phi: 1.571 }));
/// let mut chain = SignalChain::new(calibration, WrenchChain::new(stage, mounting));
/// let found: Vec<_> = chain.over(sensor).collect::<Result<_, _>>()?;
/// assert_eq!(found.len(), 90);
/// assert_eq!(found[9].quality, Quality::GAP_BEFORE);
/// assert!((found[50].reactions.f0x + 0.2).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
