//! The samples of a simulated recording, one after the other.

use super::{Simulation, SimulationError};
use crate::scene::{Leg, LegPath};
use vibrissa::contact::{Item, RollerContact, Stop};
use vibrissa::reconstruct::{Dropout, NoiseGenerator, NoiseModel};
use vibrissa::rod::{AnyRod, Reactions};
use vibrissa::{Label, Pose, State, Sweep};

/// One sample that the sensor took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Its number, from 0 at the start of the path: the time is so many periods.
    pub number: usize,
    /// The clamp.
    pub pose: Pose,
    /// The true phase.
    pub label: Label,
    /// What the sensor read; none where that was lost.
    pub reactions: Option<Reactions>,
    /// What the sensor of a roller read, N; none without a roller.
    pub roller: Option<f64>,
}

/// The samples along a scene, in order; an error where the sweep stops early, and nothing after it. Poses that a snap jumps
/// over have no sample, but a number.
#[derive(Debug)]
pub struct Ticks<'a> {
    sweep: Sweep<'a, AnyRod>,
    /// The legs of the path, the way between two samples on each, and the number of the sample at its start.
    legs: Vec<(LegPath, f64, usize)>,
    /// About how many samples there are.
    pub(super) expected: f64,
    sensor: NoiseGenerator,
    /// That of a roller, which has one channel.
    roller: NoiseGenerator,
    /// Number of the next sample.
    next: usize,
}

impl Simulation {
    /// The samples. The memory they take does not grow with their number.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn ticks(&self) -> Result<Ticks<'_>, SimulationError> {
        let ((steps, expected), sensor) = (self.steps()?, self.noise.generator(self.seed)?);
        // a sample is lost as a whole
        let of_roller = NoiseModel { dropout: Dropout::default(), crosstalk: [[0.0; 3]; 3], ..self.noise };
        let roller = of_roller.generator(self.seed ^ ROLLER_SEED)?;
        let sweep = self.scene.sweep_by(&steps)?;
        let mut first = 0;
        let leg = |(leg, step): (Leg, f64)| {
            let this = first;
            first += (leg.path.length() / step).round() as usize;
            (leg.path, step, this)
        };
        let legs = self.scene.all_legs().zip(steps).map(leg).collect();
        Ok(Ticks { sweep, legs, expected, sensor, roller, next: 0 })
    }
}

/// Makes the noise of a roller's sensor another one than that of the clamp's.
const ROLLER_SEED: u64 = 0x726f_6c6c_6572_0001;

/// Share of a step by which a state may be off its sample by rounding.
const ROUNDING: f64 = 1e-6;

impl Ticks<'_> {
    /// None of the end of the path, which the sweep reports too, where no sample is due.
    fn tick(&mut self, state: &State) -> Option<Tick> {
        let (path, step, first) = &self.legs[state.leg];
        let due = path.way(state.pose) / step;
        if (due - due.round()).abs() > ROUNDING {
            return None;
        }
        let number = first + due.round() as usize;
        // The sensor goes on where the sweep has nothing to report.
        for _ in self.next..number {
            self.sensor.sample(Reactions::default());
            self.roller.sample(Reactions::default());
        }
        self.next = number + 1;
        let phase = state.phase();
        let label = Label::of(phase.contacts, phase.tip);
        let force = |roller: &RollerContact| Reactions { f0x: roller.force, ..Reactions::default() };
        let roller = state.roller.as_deref().and_then(|roller| self.roller.sample(force(roller))).map(|read| read.f0x);
        Some(Tick { number, pose: state.pose, label, reactions: self.sensor.sample(state.reactions), roller })
    }
}

impl Iterator for Ticks<'_> {
    type Item = Result<Tick, Stop>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            return match self.sweep.next()? {
                Ok(Item::State(state)) => match self.tick(&state) {
                    None => continue,
                    tick => tick.map(Ok),
                },
                Ok(Item::Event(_)) => continue,
                Err(stop) => Some(Err(stop)),
            };
        }
    }
}
