//! What a fake sensor is to be.

use rod_hw::device::rdt::RdtScaling;
use rod_hw::{Dimension, Unit};
use std::net::{Ipv4Addr, SocketAddr};

/// What a fake sensor is, how fast, and how it goes wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct FakeRdtSettings {
    /// Where it listens; port 0 takes any that is free.
    pub address: SocketAddr,
    /// Where it tells its scaling over TCP, if at all; port 0 takes any that is free.
    pub scaling_address: Option<SocketAddr>,
    /// Records a second; none means as fast as possible.
    pub rate: Option<f64>,
    /// What its counts are.
    pub scaling: RdtScaling,
    /// Number of the first record after a start, 1 for real ones.
    pub first_packet: u32,
    /// Number of the first sample after power-on.
    pub first_sample: u32,
    /// How far the number of the sample goes from record to record: rate of its own clock over that of the records.
    pub stride: u32,
    /// So many requests to start get lost.
    pub ignored_starts: u32,
    /// From the first start to the first record, s.
    pub start_delay: f64,
    /// What goes wrong, and with which record, from 0, at the earliest. Of several at one record, each does.
    pub faults: Vec<(u64, RdtFault)>,
}

impl Default for FakeRdtSettings {
    /// A Net F/T on any free port of this machine, 1000 records a second, 10^6 counts a N and a N m, no faults.
    fn default() -> Self {
        let any = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let unit = |name, dimension, factor| Unit { name, dimension, factor };
        Self {
            address: any,
            scaling_address: Some(any),
            rate: Some(1000.0),
            scaling: RdtScaling {
                force_unit: unit("N", Dimension::Force, 1.0),
                torque_unit: unit("N m", Dimension::Torque, 1.0),
                counts_per_force: 1e6,
                counts_per_torque: 1e6,
            },
            first_packet: 1,
            first_sample: 1,
            stride: 1,
            ignored_starts: 0,
            start_delay: 0.0,
            faults: Vec::new(),
        }
    }
}

/// What goes wrong at one record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RdtFault {
    /// It and those after it, so many in all, are never sent.
    Drop(u64),
    /// It is sent once more, so many times.
    Repeat(u64),
    /// It is sent after so many later ones.
    Overtaken(u64),
    /// Before it come so many with the sample of the one before, as of a sensor whose clock stands still.
    Stall(u64),
    /// Nothing is sent for so long, s; then it goes on where it was.
    Pause(f64),
    /// Its sample has the first number again; the packets go on.
    CountAnew,
    /// No power for so long, s: requests come to nothing, then it waits to be started and counts samples from the first number.
    PowerOff(f64),
    /// These bits are set in the status of it and those after it, so many in all.
    Status {
        /// Which bits.
        bits: u32,
        /// How many records.
        count: u64,
    },
    /// Only so many bytes of it are sent.
    Cut(usize),
    /// So many bytes more are sent with it.
    Extended(usize),
    /// Before it comes a datagram of so many bytes without meaning. The length of whole records is one byte longer.
    Garbage(usize),
    /// Before it come so many good records from another sensor.
    Foreign(u64),
}
