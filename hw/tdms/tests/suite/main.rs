//! TDMS files, as LabVIEW and NI-DAQmx write them, and as they end up on a disk.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod broken;
mod daqmx;
mod nptdms;
mod segments;
mod writer;

use tdms_file::TdmsFile;

/// The scaled values of a channel.
fn values(file: &TdmsFile<'_>, group: &str, channel: &str) -> Vec<f64> {
    file.channel(group, channel).unwrap().values().unwrap().collect()
}
