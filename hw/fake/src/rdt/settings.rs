//! The settings of a fake sensor.

use rod_hw::device::rdt::RdtScaling;
use rod_hw::{Dimension, Unit};
use std::net::{Ipv4Addr, SocketAddr};

/// The settings of a fake sensor: its scaling, its rate and its faults.
#[derive(Clone, Debug, PartialEq)]
pub struct FakeRdtSettings {
    /// Where it listens; port 0 takes any that is free.
    pub address: SocketAddr,
    /// Where it tells its scaling over TCP, if at all; port 0 takes any that is free.
    pub scaling_address: Option<SocketAddr>,
    /// Records a second; none means as fast as possible.
    pub rate: Option<f64>,
    /// The scaling of its counts.
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
    /// The faults, each with the number of the earliest record, from 0. Several faults at one record all happen.
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

/// A fault at one record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RdtFault {
    /// This number of records, from this one on, is never sent.
    Drop(u64),
    /// The record is repeated this many times.
    Repeat(u64),
    /// The record is sent after this number of later ones.
    Overtaken(u64),
    /// Before it come this many records with the sample of the one before, as from a sensor whose clock has stopped.
    Stall(u64),
    /// Nothing is sent for this time, s; then the sensor continues where it was.
    Pause(f64),
    /// Its sample has the first number again; the packets go on.
    CountAnew,
    /// No power for this time, s: requests come to nothing, then it waits to be started and counts samples from the first number.
    PowerOff(f64),
    /// These bits are set in the status of this number of records, from this one on.
    Status {
        /// Which bits.
        bits: u32,
        /// How many records.
        count: u64,
    },
    /// Only this number of its bytes is sent.
    Cut(usize),
    /// So many bytes more are sent with it.
    Extended(usize),
    /// Before it comes a datagram of this many bytes without meaning. A length of whole records becomes one byte longer.
    Garbage(usize),
    /// Before it come this many valid records from another sensor.
    Foreign(u64),
}
