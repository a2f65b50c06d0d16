//! Simulated recordings: a scene, swept at a speed, felt by a sensor.
//!
//! `ticks` is the sensor's samples one after the other, `speed` how a speed is written; here is what a recording is of, and how it is written.

mod argument;
mod speed;
mod ticks;

pub use argument::SimulationArgument;
pub use speed::Speed;
pub use ticks::{Tick, Ticks};

use crate::output::csv_writer;
use crate::{Interrupt, Interrupted, OutputError, Scene, Staged};
use std::io::{self, Write};
use std::path::Path;
use vibrissa::Pose;
use vibrissa::contact::{ContactError, Stop};
use vibrissa::reconstruct::{NoiseError, NoiseModel};
use vibrissa::rod::Reactions;

/// The columns, those of the standard deviations last.
const COLUMNS: [&str; 10] = ["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z", "sigma_f0x", "sigma_f0y", "sigma_m0z"];
const WITHOUT_SIGMAS: usize = 7;
/// The columns of a roller ahead of the clamp, behind the others: what its sensor read (N), and the standard deviation.
const ROLLER_COLUMNS: [&str; 2] = ["roller", "sigma_roller"];

/// What the comment is called that ends a recording which was interrupted, or whose sweep stopped early.
pub(crate) const INCOMPLETE: &str = "incomplete";

/// A recording to be made, SI units.
#[derive(Debug)]
pub struct Simulation {
    /// What the clamp is led along. The scene's own step is not used.
    pub scene: Scene,
    /// The sensor; zeros for one that reads the truth.
    pub noise: NoiseModel,
    /// Samples in a second, 1/s.
    pub rate: f64,
    /// Speed of the clamp, as of [`Ticks::new`].
    pub speed: f64,
    /// Of the noise.
    pub seed: u64,
    /// Whether to write the standard deviations of the noise, too.
    pub sigmas: bool,
}

/// What was recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Simulated {
    /// How many samples were written.
    pub samples: usize,
    /// How many were lost in dropouts.
    pub lost: usize,
    /// Why the sweep stopped before the end of the path, if it did.
    pub stop: Option<Stop>,
    /// Where the clamp was when the simulation was interrupted, if it was.
    pub interrupted: Option<Interrupted>,
}

/// Why a recording cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// An argument is not possible.
    #[error(transparent)]
    Argument(#[from] SimulationArgument),
    /// The noise model is not possible.
    #[error(transparent)]
    Noise(#[from] NoiseError),
    /// There is no such sweep.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The recording cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Simulation {
    /// Sweeps the scene and writes a sample every `speed / rate` of the clamp's way to the CSV file `out`, which
    /// appears when it is complete: t, x0, y0, phi0, f0x, f0y, m0z, and the standard deviations where they are asked
    /// for. The samples are those of [`Ticks`].
    ///
    /// The memory it takes does not grow with the number of samples.
    ///
    /// Interrupted, or where the sweep stops early, it ends the file with the comment `# incomplete: ` and where that was; [`Recording`](crate::Recording)
    /// reads it. A roller ahead of the clamp has a column `roller` (N), with the noise of the channel f0x but for crosstalk, independent of
    /// that, and a column `sigma_roller`. Before the first sample it writes no file. It replaces none of the files of the scene.
    ///
    /// # Errors
    /// [`SimulationError`]. A sweep that stops early is none: what there is, is
    /// written.
    pub fn write(&self, out: &Path, interrupt: &Interrupt) -> Result<Simulated, SimulationError> {
        let samples = self.samples()?;
        let (staged, name) = Staged::of_file(out)?;
        let staged = staged.keeping(self.scene.files.clone());
        let mut recorded = Simulated::default();
        staged.write(name, |out| {
            recorded = samples.record(out, interrupt)?;
            Ok(())
        })?;
        if recorded.interrupted.is_some() && recorded.samples == 0 {
            return Ok(recorded);
        }
        staged.publish()?;
        Ok(recorded)
    }

    /// The same to standard output or another stream.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn write_to(&self, out: &mut dyn Write, interrupt: &Interrupt) -> Result<Simulated, SimulationError> {
        Ok(self.samples()?.record(out, interrupt).map_err(OutputError::Standard)?)
    }

    fn samples(&self) -> Result<RecordedSamples<'_>, SimulationError> {
        let sigma = if self.sigmas { Some(self.sigma()?) } else { None };
        Ok(RecordedSamples { simulation: self, sigma, ticks: self.ticks()? })
    }

    fn row(&self, number: usize, pose: Pose, reactions: Reactions, sigma: Reactions) -> [f64; COLUMNS.len()] {
        let (Pose { x, y, phi }, Reactions { f0x, f0y, m0z }) = (pose, reactions);
        let t = number as f64 / self.rate;
        [t, x, y, phi, f0x, f0y, m0z, sigma.f0x, sigma.f0y, sigma.m0z]
    }

    fn sigma(&self) -> Result<Reactions, SimulationError> {
        let sigma = self.noise.sigma();
        let channels = [("f0x", sigma.f0x), ("f0y", sigma.f0y), ("m0z", sigma.m0z)];
        match channels.into_iter().find(|(_, sigma)| *sigma <= 0.0) {
            Some((channel, _)) => Err(SimulationArgument::NoSigma { channel }.into()),
            None => Ok(sigma),
        }
    }
}

/// The samples of a recording that is being written.
struct RecordedSamples<'a> {
    simulation: &'a Simulation,
    sigma: Option<Reactions>,
    ticks: Ticks<'a>,
}

impl RecordedSamples<'_> {
    fn record(mut self, out: &mut dyn Write, interrupt: &Interrupt) -> io::Result<Simulated> {
        let mut recorded = Simulated::default();
        let mut last = None;
        let columns = if self.sigma.is_some() { COLUMNS.len() } else { WITHOUT_SIGMAS };
        let mut table = csv_writer(out);
        let of_roller = match (self.simulation.scene.rod.roller().is_some(), self.sigma) {
            (false, _) => 0,
            (true, None) => 1,
            (true, Some(_)) => 2,
        };
        table.write_record(COLUMNS[..columns].iter().chain(&ROLLER_COLUMNS[..of_roller]))?;
        loop {
            if interrupt.is_raised() {
                recorded.interrupted = Some(Interrupted { pose: last });
                break;
            }
            match self.ticks.next() {
                Some(Ok(Tick { number, pose, reactions, roller, .. })) => {
                    last = Some(pose);
                    interrupt.pass(number as f64 / self.ticks.expected);
                    let Some(reactions) = reactions else {
                        recorded.lost += 1;
                        continue;
                    };
                    let sigma = self.sigma.unwrap_or_default();
                    let row = self.simulation.row(number, pose, reactions, sigma);
                    let roller = [roller.unwrap_or(f64::NAN), sigma.f0x];
                    table.serialize((&row[..columns], &roller[..of_roller]))?;
                    recorded.samples += 1;
                }
                Some(Err(stop)) => recorded.stop = Some(stop),
                None => break,
            }
        }
        table.flush()?;
        drop(table);
        match (&recorded.interrupted, &recorded.stop) {
            (Some(at), _) => writeln!(out, "# {INCOMPLETE}: {at}")?,
            (None, Some(stop)) => writeln!(out, "# {INCOMPLETE}: {stop}")?,
            (None, None) => {}
        }
        Ok(recorded)
    }
}
