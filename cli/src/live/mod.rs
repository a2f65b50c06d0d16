//! A sensor, read and reconstructed as it measures.
//!
//! `address` and `stage` are what the command line tells of both, `sensor` connects to the one, or `played` opens a recording, and
//! `motion` is the other;
//! `head` listens until there is a tare and `noise`, `session` is the scan from the first sample to the last, with `engine` for the answers, `record` for the files and
//! `summary` for what is said of it.

mod address;
mod engine;
mod error;
mod feed;
mod head;
mod latency;
mod motion;
mod noise;
mod played;
mod record;
mod sensor;
mod session;
mod stage;
mod summary;

pub use address::{AddressError, SensorAddress};
pub use engine::{Answer, Engine};
pub use error::LiveError;
pub use feed::{Fed, Feed, Miss};
pub use latency::Latency;
pub use sensor::Sensor;
pub use stage::{StageSpec, StageSpecError};
pub use summary::{End, LiveReport};

use crate::{Error, Reading, Setup};
use std::path::{Path, PathBuf};
use vibrissa::{ClampPath, Rod};

/// A scan to be made with a sensor.
#[derive(Clone, Debug)]
pub struct LiveScan {
    /// The rod.
    pub rod: Rod,
    /// How the sensor is set up.
    pub setup: Setup,
    /// How the clamp moves; none where the samples tell.
    pub stage: Option<StageSpec>,
    /// Its path, which a constant speed needs.
    pub path: Option<ClampPath>,
    /// How the table of a stage is written.
    pub reading: Reading,
    /// Files that are read, which are not to be overwritten.
    pub inputs: Vec<PathBuf>,
}

impl LiveScan {
    /// Listens to the sensor until the clamp has arrived, there are no more samples, the sensor falls silent, or `stopped`
    /// says so. Writes recording.csv, points.jsonl and summary.json into `out`, the first two as it goes. `tell` is handed
    /// lines to show.
    ///
    /// The first samples, [`TareSetup::seconds`](crate::TareSetup) of them, must be of the free rod: they are the tare, and
    /// tell the noise. The stage sets off with the first sample.
    ///
    /// # Errors
    /// [`Error::Live`], [`Error::Output`].
    pub fn run(
        &self,
        sensor: Sensor,
        out: &Path,
        tell: &mut dyn FnMut(&str),
        stopped: &dyn Fn() -> bool,
    ) -> Result<LiveReport, Error> {
        record::check(out, &self.inputs)?;
        session::run(self, sensor, out, tell, stopped)
    }
}
