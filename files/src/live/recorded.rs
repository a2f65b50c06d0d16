//! A recording of a sensor: raw values or wrenches, in a table, a TDMS or an MCAP file.

use super::address::SensorAddress;
use super::error::LiveError;
use super::feed::Sensor;
use super::scan::LiveScan;
use crate::{Place, Recording, RecordingError, Row, RowFault, RowProblem};
use std::path::Path;
use vibrissa::hw::ReactionSample;

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
        let whole = self.whole(sensor)?;
        let rows = (1..).map(Place::Sample).zip(whole.samples).map(|(place, sample)| (place, row(place, sample)));
        let mut notes = whole.remarks;
        if whole.beyond > 0 {
            notes.push(format!("{} samples after the arrival of the stage are left out", whole.beyond));
        }
        Ok(Recording { notes, ..Recording::of_rows(file.to_path_buf(), rows, &self.rod)? })
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
