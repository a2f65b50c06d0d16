//! A protocol on a transport.

use super::clock::Clock;
use super::counters::LinkCounters;
use super::protocol::{FrameFault, Protocol};
use super::transport::Transport;
use crate::sample::{Quality, RawSample};
use core::time::Duration;

/// Size of the buffer, bytes: longer than any datagram of these devices.
const BUFFER: usize = 2048;

/// Poll interval of requests, s.
const TICK: f64 = 0.05;

/// Shortest time to wait for, s: a clock of finite resolution may not advance by less.
const INSTANT: f64 = 1e-6;

/// Shortest time between two attempts to reconnect, s.
const BREATH: f64 = 1e-3;

/// Deadline, limit of faults and reconnection of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkSettings {
    /// How long to wait for a sample before that is an error, s.
    pub deadline: f64,
    /// Number of faulty frames in a row that is an error.
    pub storm: u32,
    /// The reaction to a broken connection.
    pub reconnect: Reconnect,
}

/// The reaction to a broken connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reconnect {
    /// Report it and end.
    Never,
    /// Reconnect after a pause that doubles with each failure until samples come.
    After {
        /// Pause before the first attempt, s.
        first: f64,
        /// Longest pause, s.
        most: f64,
    },
}

impl Default for LinkSettings {
    /// 1 s, 10 frames, reconnect after 0.25 to 5 s.
    fn default() -> Self {
        Self { deadline: 1.0, storm: 10, reconnect: Reconnect::After { first: 0.25, most: 5.0 } }
    }
}

/// Why there is no sample.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError<E> {
    /// Nothing came in time.
    #[error("no sample within {waited:.3} s ({counters}); is the device on, its address right, its data rate above 0?")]
    Timeout {
        /// How long, s.
        waited: f64,
        /// The counters so far.
        counters: LinkCounters,
    },
    /// Nothing but faulty frames.
    #[error("{count} faulty frames in a row, the last: {last}")]
    Storm {
        /// How many.
        count: u32,
        /// The last one.
        last: FrameFault,
    },
    /// The device refuses what it is asked to do, which goes on being asked for.
    #[error("{0}")]
    Refused(FrameFault),
    /// The connection is broken. Where the settings say so, the link tries to re-establish it while it is asked for samples.
    #[error("the connection is broken: {0}")]
    Broken(E),
}

/// Raw samples from a device: a protocol on a transport, as an iterator that answers within its deadline, always. It ends
/// only where the connection breaks and is not to be re-established.
///
/// No threads and no allocation: what arrives while nobody asks is left to the buffers of the transport. Memory is one
/// buffer of 2 KiB.
#[derive(Debug)]
pub struct Link<T, P: Protocol, C> {
    transport: T,
    protocol: P,
    clock: C,
    settings: LinkSettings,
    buffer: [u8; BUFFER],
    /// The part of the buffer that is not decoded, and its time of arrival.
    rest: (usize, usize),
    arrived: f64,
    /// Faulty frames in a row.
    faults: u32,
    connection: Connection,
    /// Pause before the next attempt to reconnect, s, after one that failed or brought no sample.
    pause: Option<f64>,
    requests: u64,
    reconnects: u64,
    /// For the next sample.
    flags: Quality,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Connection {
    Up,
    /// Broken; to be tried at a time.
    Down {
        at: f64,
    },
    Ended,
}

impl<T: Transport, P: Protocol, C: Clock> Link<T, P, C> {
    /// Ready to ask for the first sample.
    pub fn new(transport: T, protocol: P, clock: C, settings: LinkSettings) -> Self {
        Self {
            transport,
            protocol,
            clock,
            settings,
            buffer: [0; BUFFER],
            rest: (0, 0),
            arrived: 0.0,
            faults: 0,
            connection: Connection::Up,
            pause: None,
            requests: 0,
            reconnects: 0,
            flags: Quality::empty(),
        }
    }

    /// The counters of received and lost samples.
    pub fn counters(&self) -> LinkCounters {
        LinkCounters {
            requests: self.requests,
            reconnects: self.reconnects,
            foreign: self.transport.foreign(),
            ..self.protocol.counters()
        }
    }

    /// Tells the device to stop.
    ///
    /// # Errors
    /// If the connection is broken.
    pub fn stop(&mut self) -> Result<(), T::Error> {
        self.connection = Connection::Ended;
        self.protocol.farewell().map_or(Ok(()), |bytes| self.transport.send(&bytes))
    }

    /// Decodes what has arrived, up to the next thing to tell.
    fn decode(&mut self) -> Option<Result<RawSample, LinkError<T::Error>>> {
        loop {
            let (from, to) = self.rest;
            let mut bytes = &self.buffer[from..to];
            let decoded = self.protocol.decode(&mut bytes, self.arrived);
            self.rest.0 = to - bytes.len();
            match decoded {
                None => return None,
                Some(Ok(mut sample)) => {
                    self.faults = 0;
                    self.pause = None;
                    sample.quality |= core::mem::take(&mut self.flags);
                    return Some(Ok(sample));
                }
                Some(Err(fault @ FrameFault::Refused { .. })) => return Some(Err(LinkError::Refused(fault))),
                Some(Err(last)) => {
                    self.faults += 1;
                    if self.faults >= self.settings.storm {
                        let count = core::mem::take(&mut self.faults);
                        return Some(Err(LinkError::Storm { count, last }));
                    }
                }
            }
        }
    }

    /// Asks the device for what is due and waits for bytes, at most `left` seconds.
    fn exchange(&mut self, now: f64, left: f64) -> Result<(), T::Error> {
        if let Some(bytes) = self.protocol.request(now) {
            self.transport.send(&bytes)?;
            self.requests += 1;
        }
        let wait = Duration::try_from_secs_f64(left.min(TICK)).unwrap_or_default();
        if let Some(count) = self.transport.receive(&mut self.buffer, wait)? {
            self.arrived = self.clock.now();
            self.rest = (0, count.min(BUFFER));
        }
        Ok(())
    }

    /// The connection broke, or could not be made.
    fn down(&mut self) {
        self.connection = match self.settings.reconnect {
            Reconnect::Never => Connection::Ended,
            Reconnect::After { first, most } => {
                let pause = self.pause.unwrap_or(first).min(most).max(BREATH);
                self.pause = Some(2.0 * pause);
                Connection::Down { at: self.clock.now() + pause }
            }
        };
    }
}

impl<T: Transport, P: Protocol, C: Clock> Iterator for Link<T, P, C> {
    type Item = Result<RawSample, LinkError<T::Error>>;

    fn next(&mut self) -> Option<Self::Item> {
        let since = self.clock.now();
        loop {
            if let Some(decoded) = self.decode() {
                return Some(decoded);
            }
            let now = self.clock.now();
            let left = self.settings.deadline - (now - since);
            match self.connection {
                Connection::Ended => return None,
                _ if left.is_nan() || left < INSTANT => {
                    return Some(Err(LinkError::Timeout { waited: now - since, counters: self.counters() }));
                }
                Connection::Down { at } if now + INSTANT < at => self.clock.wait(left.min(at - now)),
                Connection::Down { .. } => {
                    if self.transport.reconnect().is_ok() {
                        self.connection = Connection::Up;
                        self.reconnects += 1;
                        self.protocol.reset();
                        // the device may have been off, which not every counter tells
                        self.flags |= Quality::GAP_BEFORE | Quality::RESTARTED;
                    } else {
                        self.down();
                    }
                }
                Connection::Up => {
                    if let Err(error) = self.exchange(now, left) {
                        self.rest = (0, 0);
                        self.down();
                        return Some(Err(LinkError::Broken(error)));
                    }
                }
            }
        }
    }
}
