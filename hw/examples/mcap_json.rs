//! The wrenches in an MCAP file, as JSON: `cargo run -p rod-hw --features mcap --example mcap_json -- FILE`.
#![allow(clippy::print_stdout, reason = "an example prints")]

use rod_hw::WrenchSample;
use rod_hw::recording::mcap::{McapError, McapFile};
use serde_json::{Map, Value, json};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("expected the path of an MCAP file")?;
    let file = McapFile::read(path)?;
    let mut topics = Map::new();
    for topic in file.topics().iter().filter(|topic| topic.type_name.ends_with("/WrenchStamped")) {
        // why a file breaks off is told below
        let good = file.wrenches(&topic.name)?.filter(|found| !matches!(found, Err(McapError::Fault(_))));
        let values: Vec<Value> = good.map(|found| found.map(value)).collect::<Result<_, _>>()?;
        topics.insert(topic.name.clone(), values.into());
    }
    println!("{}", json!({ "fault": file.fault().map(ToString::to_string), "topics": topics }));
    Ok(())
}

fn value(sample: WrenchSample) -> Value {
    json!({ "log": sample.raw.host_time, "stamp": sample.raw.device_time, "values": sample.wrench.components() })
}
