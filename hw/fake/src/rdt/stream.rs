//! The records that a fake sensor sends.

use super::account::Shared;
use super::pace::Pace;
use super::settings::{FakeRdtSettings, RdtFault};
use rod_hw::device::rdt::RdtRecord;
use std::collections::VecDeque;
use std::net::{SocketAddr, UdpSocket};
use std::sync::PoisonError;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// How soon it notices that it is to end, or restarted.
const TICK: Duration = Duration::from_millis(20);

/// The stream of records, on the way to whoever started it.
pub(super) struct Stream<'a> {
    shared: &'a Shared,
    socket: UdpSocket,
    foreign: UdpSocket,
    faults: VecDeque<(u64, RdtFault)>,
    pace: Pace,
    first_packet: u32,
    first_sample: u32,
    stride: u32,
    start_delay: f64,
    /// Number of the start that the packets are counted from.
    start: u64,
    packet: u32,
    sample: u32,
    /// Records after this one with the same fault: bits of the status and how many, how many to drop.
    status: (u32, u64),
    to_drop: u64,
    /// The datagram that is being filled.
    datagram: Datagram,
    /// Datagrams that are to be overtaken by so many more records.
    held: Vec<(u64, Datagram)>,
    last: RdtRecord,
}

/// Some records, and what is to become of them.
#[derive(Clone, Default)]
struct Datagram {
    bytes: Vec<u8>,
    records: u64,
    flagged: u64,
    drop: bool,
    repeat: u64,
    overtaken: u64,
    cut: Option<usize>,
    extended: usize,
}

impl<'a> Stream<'a> {
    pub(super) fn new(shared: &'a Shared, settings: &FakeRdtSettings, socket: UdpSocket, foreign: UdpSocket) -> Self {
        let mut faults = settings.faults.clone();
        faults.sort_by_key(|(at, _)| *at);
        let period = settings.rate.filter(|rate| *rate > 0.0).map_or(0.0, f64::recip);
        Self {
            shared,
            socket,
            foreign,
            faults: faults.into(),
            pace: Pace::new(period),
            first_packet: settings.first_packet,
            first_sample: settings.first_sample,
            stride: settings.stride,
            start_delay: settings.start_delay,
            start: 0,
            packet: settings.first_packet,
            sample: settings.first_sample,
            status: (0, 0),
            to_drop: 0,
            datagram: Datagram::default(),
            held: Vec::new(),
            last: RdtRecord::default(),
        }
    }

    /// Sends the samples when they are due, to whoever started the stream.
    pub(super) fn run(mut self, samples: impl Iterator<Item = RdtRecord>) {
        let mut samples = samples.fuse();
        let mut number = 0;
        while let Some(client) = self.due() {
            while self.faults.front().is_some_and(|(at, _)| *at <= number) {
                if let Some((_, fault)) = self.faults.pop_front() {
                    self.go_wrong(fault, client);
                }
            }
            // without power, or it took time
            let Some(client) = self.due() else { return };
            let Some(sample) = samples.next() else { break };
            self.put(sample, client);
            number += 1;
        }
        let client = self.shared.lock().client;
        if let Some(client) = client {
            self.flush(client);
            self.release(client, u64::MAX);
        }
    }

    fn stopped(&self) -> bool {
        self.shared.stop.load(Ordering::Relaxed)
    }

    /// Waits until a record is due, and returns whom it is for. None at the end of all.
    fn due(&mut self) -> Option<SocketAddr> {
        loop {
            if self.stopped() {
                return None;
            }
            let state = self.shared.lock();
            let Some(client) = state.client.filter(|_| !state.off) else {
                drop(self.shared.changed.wait_timeout(state, TICK).unwrap_or_else(PoisonError::into_inner));
                let unsent = core::mem::take(&mut self.datagram).records;
                self.shared.lock().account.dropped += unsent;
                self.pace.delay(0.0);
                continue;
            };
            let start = state.start;
            drop(state);
            if self.start != start {
                if self.start == 0 {
                    self.pace.delay(self.start_delay);
                }
                self.start = start;
                self.packet = self.first_packet;
            }
            match self.pace.left() {
                Duration::ZERO => return Some(client),
                left => thread::sleep(left.min(TICK)),
            }
        }
    }

    /// The faults at the next record.
    fn go_wrong(&mut self, fault: RdtFault, client: SocketAddr) {
        match fault {
            RdtFault::Drop(count) => self.to_drop = count,
            RdtFault::Repeat(count) => self.datagram.repeat += count,
            RdtFault::Overtaken(count) => self.datagram.overtaken = count,
            RdtFault::Stall(count) => {
                for _ in 0..count {
                    self.shared.lock().account.stalled += 1;
                    self.sample = self.sample.wrapping_sub(self.stride);
                    self.put(self.last, client);
                }
            }
            RdtFault::Pause(seconds) => self.pace.delay(seconds),
            RdtFault::CountAnew => self.sample = self.first_sample,
            RdtFault::PowerOff(seconds) => {
                self.flush(client);
                let mut state = self.shared.lock();
                (state.client, state.off) = (None, true);
                drop(state);
                let (since, off) = (Instant::now(), Duration::try_from_secs_f64(seconds).unwrap_or_default());
                while since.elapsed() < off && !self.stopped() {
                    thread::sleep(TICK.min(off.saturating_sub(since.elapsed())));
                }
                self.sample = self.first_sample;
                self.shared.lock().off = false;
            }
            RdtFault::Status { bits, count } => self.status = (bits, count),
            RdtFault::Cut(bytes) => self.datagram.cut = Some(bytes),
            RdtFault::Extended(bytes) => self.datagram.extended = bytes,
            RdtFault::Garbage(bytes) => {
                let bytes = bytes + usize::from(bytes.is_multiple_of(RdtRecord::BYTES));
                self.send(client, &vec![0xA5; bytes]);
                self.shared.lock().account.malformed += 1;
            }
            RdtFault::Foreign(count) => {
                for _ in 0..count {
                    // that it may not arrive is the network's affair
                    let _ = self.foreign.send_to(&self.last.to_bytes(), client);
                }
                self.shared.lock().account.foreign += count;
            }
        }
    }

    /// Makes a record and sends it.
    fn put(&mut self, mut record: RdtRecord, client: SocketAddr) {
        if self.status.1 > 0 {
            self.status.1 -= 1;
            record.status |= self.status.0;
        }
        (record.packet, record.sample) = (self.packet, self.sample);
        self.packet = self.packet.wrapping_add(1);
        self.sample = self.sample.wrapping_add(self.stride);
        self.last = record;
        self.pace.step();
        if self.to_drop > 0 {
            self.to_drop -= 1;
            self.datagram.drop = true;
        }
        self.datagram.bytes.extend(record.to_bytes());
        self.datagram.records += 1;
        self.datagram.flagged += u64::from(record.status != 0);
        let mut state = self.shared.lock();
        state.account.records += 1;
        state.left = state.left.map(|left| left.saturating_sub(1));
        if state.left == Some(0) {
            state.client = None;
        }
        drop(state);
        self.flush(client);
    }

    /// The datagram goes its way, and those that it overtakes the last.
    fn flush(&mut self, client: SocketAddr) {
        let datagram = core::mem::take(&mut self.datagram);
        if datagram.records == 0 {
            return;
        }
        match datagram.overtaken {
            0 => {
                let records = datagram.records;
                self.deliver(client, &datagram);
                self.release(client, records);
            }
            count => self.held.push((count, datagram)),
        }
    }

    /// So many records went by those that are held.
    fn release(&mut self, client: SocketAddr, records: u64) {
        for (left, datagram) in core::mem::take(&mut self.held) {
            if left > records {
                self.held.push((left - records, datagram));
            } else {
                self.deliver(client, &datagram);
                self.shared.lock().account.overtaken += datagram.records;
            }
        }
    }

    fn deliver(&mut self, client: SocketAddr, datagram: &Datagram) {
        let Datagram { records, repeat, .. } = *datagram;
        if datagram.drop {
            self.shared.lock().account.dropped += records;
            return;
        }
        let mut bytes = datagram.bytes.clone();
        bytes.truncate(datagram.cut.unwrap_or(usize::MAX));
        bytes.resize(bytes.len() + datagram.extended, 0xA5);
        let damaged = bytes.len() != datagram.bytes.len();
        for _ in 0..=repeat {
            self.send(client, &bytes);
        }
        let account = &mut self.shared.lock().account;
        if damaged {
            account.damaged += records;
            account.malformed += 1 + repeat;
        } else {
            account.sent += records;
            account.flagged += datagram.flagged;
            account.repeated += repeat * records;
        }
    }

    fn send(&self, client: SocketAddr, bytes: &[u8]) {
        // that nobody takes it is nothing to a sensor
        let _ = self.socket.send_to(bytes, client);
    }
}
