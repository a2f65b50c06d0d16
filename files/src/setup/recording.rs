//! What of a recording is meant, where it has more than that.

use super::calibration::{Gauges, SensorCalibration};
use super::document::RecordingTable;
use super::field::positive;
use crate::toml_file::Fault;
use toml::{Spanned, Value};

/// What of a recording is meant. What does not concern a kind of file is not looked at there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordingSetup {
    /// The columns of a table, or channels of a group (TDMS), that are the raw values, in order.
    pub columns: Option<Vec<String>>,
    /// The group of the channels (TDMS).
    pub group: Option<String>,
    /// Where the times are.
    pub time: RecordingTime,
    /// The topic of the wrenches (MCAP).
    pub topic: Option<String>,
}

/// Where the times of a recording are.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum RecordingTime {
    /// Where the file says: on the axis of the channels (TDMS), in the column of this meaning (tables).
    #[default]
    Own,
    /// In the channel or column of this name.
    Named(String),
    /// So many samples a second, Hz (TDMS).
    Rate(f64),
}

pub(super) fn recording(
    table: &RecordingTable,
    calibration: Option<&SensorCalibration>,
) -> Result<RecordingSetup, Fault> {
    if let (Some(columns), Some(SensorCalibration::Gauges(gauges))) = (&table.columns, calibration) {
        fits(columns, gauges)?;
    }
    let text = |field: &Option<Spanned<String>>| field.as_ref().map(|field| field.get_ref().clone());
    Ok(RecordingSetup {
        columns: table.columns.as_ref().map(|columns| columns.get_ref().clone()),
        group: text(&table.group),
        time: table.time.as_ref().map_or(Ok(RecordingTime::Own), time)?,
        topic: text(&table.topic),
    })
}

fn fits(columns: &Spanned<Vec<String>>, gauges: &Gauges) -> Result<(), Fault> {
    let (found, expected) = (columns.get_ref().len(), gauges.channels());
    if found == expected {
        return Ok(());
    }
    let message = format!(
        "{found} columns, expected {expected}: those of the gauges in the order of the calibration, then that of the \
         thermometer where it compensates for temperature"
    );
    Err(Fault::new(columns.span(), message))
}

fn time(field: &Spanned<Value>) -> Result<RecordingTime, Fault> {
    let rate = |value: &Value| match value {
        Value::Float(rate) => Some(*rate),
        Value::Integer(rate) => Some(*rate as f64),
        _ => None,
    };
    match field.get_ref() {
        Value::String(name) if name == "waveform" => return Ok(RecordingTime::Own),
        Value::String(name) => return Ok(RecordingTime::Named(name.clone())),
        Value::Table(table) if table.len() == 1 => {
            if let Some(rate) = table.get("rate").and_then(rate) {
                return positive("rate", &Spanned::new(field.span(), rate), "Hz").map(RecordingTime::Rate);
            }
        }
        _ => {}
    }
    Err(Fault::new(field.span(), "expected \"waveform\", the name of a channel or column, or { rate = NUMBER } in Hz"))
}
