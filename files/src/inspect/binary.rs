//! Files of LabVIEW (TDMS) and of ROS (MCAP): what they hold.

use super::report::{InspectedFile, Question};
use std::path::Path;
use vibrissa::hw::recording::mcap::McapFile;
use vibrissa::hw::recording::tdms::TdmsFile;

/// What a TDMS file holds.
pub(super) fn tdms(path: &Path, file: &mut InspectedFile) {
    "raw values in LabVIEW's TDMS".clone_into(&mut file.kind);
    let opened = match TdmsFile::read(path) {
        Ok(opened) => opened,
        Err(error) => return file.prevents(None, "file", error.to_string(), "a TDMS file"),
    };
    for group in opened.groups() {
        let channels: Vec<String> = group
            .channels()
            .map(|channel| {
                channel.unit().map_or_else(|| channel.name().to_owned(), |unit| format!("{} [{unit}]", channel.name()))
            })
            .collect();
        file.fact("group", format!("`{}` with {}", group.name(), channels.join(", ")));
    }
    if let Some(fault) = opened.fault() {
        file.fault(None, "file", fault.to_string(), "a file that is complete");
    }
}

/// What an MCAP file holds; the topic of wrenches, if there is one only.
pub(super) fn mcap(path: &Path, file: &mut InspectedFile) -> Option<String> {
    "wrenches of ROS in MCAP".clone_into(&mut file.kind);
    let opened = match McapFile::read(path) {
        Ok(opened) => opened,
        Err(error) => {
            file.prevents(None, "file", error.to_string(), "an MCAP file");
            return None;
        }
    };
    let mut wrenches = Vec::new();
    for topic in opened.topics() {
        file.fact("topic", format!("`{}` of {}, {} messages", topic.name, topic.type_name, topic.messages));
        if topic.type_name.ends_with("WrenchStamped") {
            wrenches.push(topic.name.clone());
        }
    }
    if let Some(fault) = opened.fault() {
        file.fault(None, "file", fault.to_string(), "a file that is complete");
    }
    match &wrenches[..] {
        [only] => return Some(only.clone()),
        [] => file.prevents(None, "topics", "no wrench", "a topic of geometry_msgs/WrenchStamped"),
        _ => file.questions.push(Question {
            text: "which topic is that of the sensor at the clamp?".to_owned(),
            answers: wrenches
                .iter()
                .map(|name| format!("--setup FILE with topic = \"{name}\" in [recording]"))
                .collect(),
        }),
    }
    None
}
