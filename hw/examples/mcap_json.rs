//! What is in an MCAP file, as JSON: `cargo run -p rod-hw --features mcap --example mcap_json -- FILE`.
#![allow(clippy::print_stdout, reason = "an example prints")]

use rod_hw::Wrench;
use rod_hw::mcap::{McapError, McapFile, Message, RosJoints, RosPose, Stamped};
use serde_json::{Map, Value, json};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("expected the path of an MCAP file")?;
    let file = McapFile::read(path)?;
    let mut topics = Map::new();
    for topic in file.topics() {
        let name = topic.name.as_str();
        let found = match topic.type_name.rsplit('/').next().unwrap_or_default() {
            "WrenchStamped" => messages(&file, name, |wrench: Wrench| json!(wrench.components()))?,
            "PoseStamped" => messages(&file, name, |pose: RosPose| {
                json!([pose.position.as_slice(), pose.orientation.as_slice()].concat())
            })?,
            "JointState" => messages(&file, name, |joints: RosJoints| {
                json!([joints.names, joints.positions, joints.velocities, joints.efforts])
            })?,
            _ => continue,
        };
        topics.insert(name.to_owned(), found);
    }
    println!("{}", json!({ "fault": file.fault().map(ToString::to_string), "topics": topics }));
    Ok(())
}

fn messages<M: Message>(file: &McapFile<'_>, topic: &str, values: impl Fn(M) -> Value) -> Result<Value, McapError> {
    let messages = file.messages::<M>(topic)?;
    let value = |Stamped { log_time, stamp, frame, message }| json!({ "log": log_time, "stamp": stamp, "frame": frame, "values": values(message) });
    // why a file breaks off is told above
    let good = messages.filter(|found| !matches!(found, Err(McapError::Fault(_))));
    good.map(|found| found.map(value)).collect()
}
