//! A whole recording of a sensor, turned into reactions as a live scan does it.

use super::address::SensorAddress;
use super::error::LiveError;
use super::feed::{Fed, Feed, Miss, Sensor};
use super::head::{Chain, Head, head};
use super::motion::Motion;
use super::scan::LiveScan;
use super::summary::LiveReport;
use crate::{Place, Recording, RecordingError, Row, RowFault, RowProblem};
use std::path::Path;
use vibrissa::Pose;
use vibrissa::hw::{Calibration, ChainError, LinkCounters, RawSample, ReactionSample, StageError, StageSource};

impl LiveScan {
    /// The recording in any file that Vibrissa reads: reactions with poses, or, where the file is TDMS or MCAP or the scan has a stage, raw
    /// values or wrenches, which setup and stage turn into reactions as in a live scan.
    ///
    /// # Errors
    /// [`LiveError`]: the file cannot be read, or its samples cannot be turned into reactions.
    pub fn recording(&self, file: &Path) -> Result<Recording, LiveError> {
        let ends = |end: &str| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(end));
        if self.stage.is_none() && !ends("tdms") && !ends("mcap") {
            return Ok(Recording::read(file, &self.rod, &self.read)?);
        }
        let sensor = Sensor::open(&SensorAddress::File(file.to_path_buf()), &self.setup, &self.read)?;
        if sensor.calibration.is_none() {
            return Err(RecordingError::Posed { file: file.to_path_buf() }.into());
        }
        let whole = self.whole(sensor, None)?;
        let rows = (1..).map(Place::Sample).zip(whole.samples).map(|(place, sample)| (place, row(place, sample)));
        let mut notes = whole.remarks;
        if whole.beyond > 0 {
            notes.push(format!("{} samples after the arrival of the stage are left out", whole.beyond));
        }
        Ok(Recording { notes, ..Recording::of_rows(file.to_path_buf(), rows, &self.rod)? })
    }

    /// The usable reactions in a file of a sensor, if the clamp stood at `pose`; their times are those of the sensor.
    ///
    /// # Errors
    /// [`LiveError`]: the file cannot be read, or its samples cannot be turned into reactions.
    pub(crate) fn standing(&self, file: &Path, pose: Pose) -> Result<Vec<ReactionSample>, LiveError> {
        let sensor = Sensor::open(&SensorAddress::File(file.to_path_buf()), &self.setup, &self.read)?;
        let whole = self.whole(sensor, Some(Motion::Standing(pose)))?;
        Ok(whole.samples.into_iter().flatten().filter(|sample| sample.quality.is_usable()).collect())
    }
}

/// The times of a sensor's recording.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorTimes {
    /// First and last time, s.
    pub span: [f64; 2],
    /// Mean step, s.
    pub step: f64,
    /// The time 0, s since 1970, where the file has it beside the times.
    pub epoch: Option<f64>,
}

impl SensorTimes {
    /// Those of a file; none where it cannot be read.
    pub(crate) fn read(file: &Path, scan: &LiveScan) -> Option<Self> {
        let mut sensor = Sensor::open(&SensorAddress::File(file.to_path_buf()), &scan.setup, &scan.read).ok()?;
        let times: Vec<f64> = std::iter::from_fn(|| sensor.feed.next())
            .flatten()
            .map(|fed| match fed {
                Fed::Raw(raw) => raw.host_time,
                Fed::Reactions(sample) => sample.t,
            })
            .collect();
        let (first, last) = (*times.first()?, *times.last()?);
        let step = (last - first) / (times.len() - 1).max(1) as f64;
        Some(Self { span: [first, last], step, epoch: sensor.epoch })
    }
}

fn row(place: Place, sample: Result<ReactionSample, String>) -> Row {
    let fault = |pose, problem| RowFault { place, pose, problem };
    let sample = sample.map_err(|text| fault(None, RowProblem::Sensor(text)))?;
    if sample.quality.is_usable() {
        Ok(sample.sample())
    } else {
        Err(fault(Some(sample.pose), RowProblem::Flagged { quality: sample.quality }))
    }
}

/// A recording as reactions.
struct RecordedReactions {
    /// For each sample its reactions, or why it has none.
    pub samples: Vec<Result<ReactionSample, String>>,
    /// Samples after the arrival of the stage, which are left out.
    pub beyond: usize,
    /// Why the sensor does not suit the rod, and other remarks.
    pub remarks: Vec<String>,
}

impl LiveScan {
    /// The reactions behind all samples of a recording, with the tare, the stage and the mounting of a live scan. The clamp moves as the stage
    /// of the scan, or by `motion`.
    ///
    /// # Errors
    /// [`LiveError`]: too few samples, no tare, or nothing tells the poses of the clamp.
    fn whole(&self, mut sensor: Sensor, motion: Option<Motion>) -> Result<RecordedReactions, LiveError> {
        let fed: Vec<Result<Fed, Miss>> =
            std::iter::from_fn(|| sensor.feed.next()).zip(0..).map(with_sequence_number).collect();
        sensor.feed = Box::new(Again { fed: fed.clone().into_iter(), handed: 0 });
        let mut report = LiveReport::new(self, &sensor.name);
        let Head { mut chain, samples, .. } = head(self, &mut sensor, motion, &mut report, &mut |_| (), &|| false)?;
        let heard = sensor.feed.counters().samples as usize;
        let mut first = samples.into_iter().peekable();
        let mut found = Vec::with_capacity(fed.len());
        let end = chain.wrenches().stage().end();
        for (number, fed) in fed.iter().enumerate() {
            found.push(match fed {
                Err(Miss::Silence(text) | Miss::Fault(text)) => Err(text.clone()),
                Ok(Fed::Reactions(sample)) => Ok(*sample),
                Ok(Fed::Raw(raw)) if number < heard => {
                    let own = first.next_if(|sample| sample.raw.sequence == Some(number as u64));
                    own.ok_or_else(|| fault(&mut chain, raw))
                }
                Ok(Fed::Raw(raw)) => match chain.take(raw) {
                    Err(ChainError::Stage(StageError::Outside { .. })) if raw.host_time > end => break,
                    taken => taken.map_err(|error| error.to_string()),
                },
            });
        }
        let beyond = fed.len() - found.len();
        Ok(RecordedReactions {
            samples: found,
            beyond,
            remarks: report.findings().iter().map(ToString::to_string).collect(),
        })
    }
}

/// The sample with its number in the recording, by which it is found again. Times of a recording are its own, so that the number that
/// the device gave it is not needed.
fn with_sequence_number((fed, number): (Result<Fed, Miss>, u64)) -> Result<Fed, Miss> {
    fed.map(|fed| match fed {
        Fed::Raw(raw) => Fed::Raw(RawSample { sequence: Some(number), ..raw }),
        Fed::Reactions(sample) => Fed::Reactions(sample),
    })
}

/// Why a sample of the head gives no reactions.
fn fault(chain: &mut Chain<'_>, raw: &RawSample) -> String {
    if let Err(error) = chain.calibration().wrench(raw) {
        return error.to_string();
    }
    match chain.wrenches().stage().pose_at(raw.host_time) {
        Err(error) => error.to_string(),
        Ok(_) => format!("no sample of the sensor at {} s: its time or its raw values are not possible", raw.host_time),
    }
}

/// Samples that were read before.
struct Again {
    fed: std::vec::IntoIter<Result<Fed, Miss>>,
    handed: u64,
}

impl Feed for Again {
    fn next(&mut self) -> Option<Result<Fed, Miss>> {
        let next = self.fed.next()?;
        self.handed += 1;
        Some(next)
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters { samples: self.handed, ..LinkCounters::default() }
    }

    fn now(&self) -> Option<f64> {
        None
    }
}
