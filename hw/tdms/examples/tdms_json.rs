//! What is in a TDMS file, as JSON: `cargo run -p tdms-file --example tdms_json -- FILE`.
#![allow(clippy::print_stdout, reason = "an example prints")]

use serde_json::{Map, Value, json};
use tdms_file::{DataType, TdmsChannel, TdmsFile, TdmsProperties, TdmsValue};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("expected the path of a TDMS file")?;
    let file = TdmsFile::read(path)?;
    let groups: Vec<Value> = file
        .groups()
        .map(|group| {
            let channels: Vec<Value> = group.channels().map(|channel| describe(&channel)).collect();
            json!({ "name": group.name(), "properties": properties(group.properties()), "channels": channels })
        })
        .collect();
    let fault = file.fault().map(ToString::to_string);
    println!("{}", json!({ "fault": fault, "properties": properties(file.properties()), "groups": groups }));
    Ok(())
}

fn describe(channel: &TdmsChannel<'_>) -> Value {
    let numbers = |values: Result<tdms_file::TdmsValues<'_>, tdms_file::TdmsError>| match values {
        Ok(values) => values.map(number).collect(),
        Err(error) => json!({ "error": error.to_string() }),
    };
    let (raw, values) = match channel.data_type() {
        Some(DataType::Text) => (Value::Null, channel.texts().map_or(Value::Null, |texts| texts.collect())),
        Some(DataType::Timestamp) => {
            let times = channel.timestamps();
            (
                Value::Null,
                times.map_or(Value::Null, |times| times.map(|time| json!([time.seconds, time.fraction])).collect()),
            )
        }
        _ => (numbers(channel.raw()), numbers(channel.values())),
    };
    json!({
        "name": channel.name(),
        "properties": properties(channel.properties()),
        "type": channel.data_type().map(|found| found.to_string()),
        "daqmx": channel.is_daqmx(),
        "unit": channel.unit(),
        "length": channel.len(),
        "time": channel.time_axis().ok().map(|axis| [axis.offset, axis.increment]),
        "raw": raw,
        "values": values,
    })
}

/// JSON has neither infinities nor NaN.
fn number(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { json!(value.to_string()) }
}

fn properties(properties: &TdmsProperties) -> Value {
    let value = |value: &TdmsValue| match value {
        TdmsValue::Integer(value) => json!(value),
        TdmsValue::Unsigned(value) => json!(value),
        TdmsValue::Real(value) => number(*value),
        TdmsValue::Bool(value) => json!(value),
        TdmsValue::Text(text) => json!(text),
        TdmsValue::Timestamp(time) => json!([time.seconds, time.fraction]),
        _ => Value::Null,
    };
    properties.iter().map(|(name, found)| (name.clone(), value(found))).collect::<Map<String, Value>>().into()
}
