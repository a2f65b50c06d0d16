//! The samples of a simulated recording, one after the other.

use super::{Simulation, SimulationArgument, SimulationError};
use crate::scene::{LegPath, MOST_STATES, RodOnPath};
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

/// The samples along the path of a clamp, in order; an error where the sweep stops early, and nothing after it. Poses that a snap jumps
/// over have no sample, but a number. Of several legs each takes a whole number of samples, at the speed that is nearest to the one asked for,
/// so that there is a sample where the clamp turns. The memory they take does not grow with their number.
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

impl<'a> Ticks<'a> {
    /// The samples that a sensor with this noise takes, `rate` in a second (Hz). `speed` is that of the clamp: m/s, or rad/s where it only
    /// turns on the whole path. On a leg on which it only turns, of others on which it moves, it is the speed in m/s of the tip of the
    /// straight rod. `seed` is that of the noise.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn new(
        swept: &RodOnPath<'a>,
        noise: &NoiseModel,
        [rate, speed]: [f64; 2],
        seed: u64,
    ) -> Result<Self, SimulationError> {
        let ((steps, expected), sensor) = (steps(swept, rate, speed)?, noise.generator(seed)?);
        // a sample is lost as a whole
        let of_roller = NoiseModel { dropout: Dropout::default(), crosstalk: [[0.0; 3]; 3], ..*noise };
        let roller = of_roller.generator(seed ^ ROLLER_SEED)?;
        let sweep = swept.sweep_by(&steps)?;
        let mut first = 0;
        let leg = |(path, step): (&LegPath, f64)| {
            let this = first;
            first += (path.length() / step).round() as usize;
            (*path, step, this)
        };
        let legs = swept.legs.iter().zip(steps).map(leg).collect();
        Ok(Self { sweep, legs, expected, sensor, roller, next: 0 })
    }
}

impl Simulation {
    /// The samples.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn ticks(&self) -> Result<Ticks<'_>, SimulationError> {
        Ticks::new(&self.scene.on_path(), &self.noise, [self.rate, self.speed], self.seed)
    }
}

/// Way of the clamp between two samples on each leg, in the unit of its parameter, and how many such ways the path is long.
fn steps(swept: &RodOnPath<'_>, rate: f64, speed: f64) -> Result<(Vec<f64>, f64), SimulationError> {
    let turns_only = swept.turns_only();
    let [unit, per_second] = if turns_only { ["rad", "rad/s"] } else { ["m", "m/s"] };
    for (what, value, unit) in [("rate", rate, "Hz"), ("speed", speed, per_second)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(SimulationArgument::NotPositive { what, value, unit }.into());
        }
    }
    let step = speed / rate;
    let way = |path: &LegPath| {
        let on_the_spot = path.turns_only() && !turns_only;
        path.length() * if on_the_spot { swept.rod.length() } else { 1.0 }
    };
    let legs: Vec<(f64, f64)> = swept.legs.iter().map(|path| (path.length(), way(path))).collect();
    let length: f64 = legs.iter().map(|leg| leg.1).sum();
    let samples = length / step;
    // Written so that it holds for a step of zero, too.
    if samples <= MOST_STATES {
        let whole = |(length, way): &(f64, f64)| length / (way / step).round().max(1.0);
        let steps = if let [_] = legs[..] { vec![step] } else { legs.iter().map(whole).collect() };
        Ok((steps, samples))
    } else {
        Err(SimulationArgument::TooMany { rate, speed, samples, length, unit }.into())
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
