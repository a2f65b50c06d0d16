//! A recording of a sensor: raw values or wrenches, in a table, a TDMS or an MCAP file.

use super::{Place, Recording, RecordingError, Row, RowFault, RowProblem};
use crate::{Error, LiveScan, Sensor, SensorAddress};
use std::path::Path;
use vibrissa::hw::ReactionSample;

impl Recording {
    /// The recording in any file that Vibrissa reads: reactions with poses, or, where the file is TDMS or MCAP or `scan` has a stage, raw
    /// values or wrenches, which setup and stage turn into reactions as in a live scan.
    ///
    /// # Errors
    /// As [`read`](Self::read); [`Error::Live`] where the samples cannot be turned into reactions.
    pub fn any(file: &Path, scan: &LiveScan) -> Result<Self, Error> {
        let ends = |end: &str| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(end));
        if scan.stage.is_none() && !ends("tdms") && !ends("mcap") {
            return Ok(Self::read(file, &scan.rod, &scan.read)?);
        }
        let sensor = Sensor::open(&SensorAddress::File(file.to_path_buf()), &scan.setup, &scan.read)?;
        if sensor.calibration.is_none() {
            return Err(RecordingError::Posed { file: file.to_path_buf() }.into());
        }
        let whole = scan.whole(sensor)?;
        let rows = (1..).map(Place::Sample).zip(whole.samples).map(|(place, sample)| (place, row(place, sample)));
        let mut notes = whole.remarks;
        if whole.beyond > 0 {
            notes.push(format!("{} samples after the arrival of the stage are left out", whole.beyond));
        }
        Ok(Self { notes, ..Self::of_rows(file.to_path_buf(), rows, &scan.rod)? })
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
