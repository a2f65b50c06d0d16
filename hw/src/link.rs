//! A protocol on a transport.

use crate::clock::Clock;
use crate::counters::LinkCounters;
use crate::protocol::{FrameFault, Protocol};
use crate::quality::Quality;
use crate::raw::RawSample;
use crate::transport::Transport;
use core::time::Duration;

/// Longer than any datagram of these devices, and so many frames of a stream at a time.
const BUFFER: usize = 2048;

/// Requests are due at this distance at most, s.
const TICK: f64 = 0.05;

/// Less than that is no time to wait for, s: a clock of finite resolution may not move by it.
const INSTANT: f64 = 1e-6;

/// Between two tries to make a connection anew, at least, s.
const BREATH: f64 = 1e-3;

/// How a link behaves when nothing good comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkSettings {
    /// How long to wait for a sample before that is an error, s.
    pub deadline: f64,
    /// So many faulty frames without a good one in between are an error.
    pub storm: u32,
    /// What to do about a broken connection.
    pub reconnect: Reconnect,
}

/// What to do about a broken connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reconnect {
    /// Report it and end.
    Never,
    /// Try again, first after so many seconds, then after twice as many each time until samples come.
    After {
        /// Before the first try, s.
        first: f64,
        /// Most, s.
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
        /// What came so far.
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
    /// The connection is broken. Where the settings say so, the link tries to make it anew while it is asked for samples.
    #[error("the connection is broken: {0}")]
    Broken(E),
}

/// Raw samples from a device: a protocol on a transport, as an iterator that answers within its deadline, always. It ends
/// only where the connection breaks and is not to be made anew.
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
    /// What is not decoded of the buffer, and when it arrived.
    rest: (usize, usize),
    arrived: f64,
    /// Faulty frames in a row.
    faults: u32,
    connection: Connection,
    /// How long to wait before the next try to make the connection anew, s, where one failed or brought no sample.
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

    /// What came so far and what did not.
    pub fn counters(&self) -> LinkCounters {
        LinkCounters {
            requests: self.requests,
            reconnects: self.reconnects,
            foreign: self.transport.foreign(),
            ..self.protocol.counters()
        }
    }

    /// The protocol, to look at its state.
    pub fn protocol(&self) -> &P {
        &self.protocol
    }

    /// The protocol, to make requests of its own.
    pub fn protocol_mut(&mut self) -> &mut P {
        &mut self.protocol
    }

    /// The clock that the samples' host times are of.
    pub fn clock(&mut self) -> &mut C {
        &mut self.clock
    }

    /// Tells the device to stop.
    ///
    /// # Errors
    /// Where the connection is broken.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::Request;
    use crate::raw::Channels;
    use std::cell::Cell;
    use std::collections::VecDeque;
    use std::rc::Rc;

    /// Time that passes only where somebody waits.
    #[derive(Clone, Default)]
    struct Manual(Rc<Cell<f64>>);

    impl Clock for Manual {
        fn now(&mut self) -> f64 {
            self.0.get()
        }
        fn wait(&mut self, seconds: f64) {
            self.0.set(self.0.get() + seconds);
        }
    }

    /// What happens at one call of the transport.
    enum Event {
        Bytes(&'static [u8]),
        Quiet,
        Broken,
    }
    use Event::{Broken, Bytes, Quiet};

    struct Script {
        clock: Manual,
        events: VecDeque<Event>,
        /// Whether the next tries to reconnect work; once there are none, they do.
        reconnects: VecDeque<bool>,
        tried: Rc<Cell<Vec<f64>>>,
        sent: Rc<Cell<usize>>,
    }

    impl Transport for Script {
        type Error = &'static str;
        fn send(&mut self, _: &[u8]) -> Result<(), Self::Error> {
            self.sent.set(self.sent.get() + 1);
            Ok(())
        }
        fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, Self::Error> {
            match self.events.pop_front() {
                Some(Bytes(bytes)) => {
                    buffer[..bytes.len()].copy_from_slice(bytes);
                    self.clock.wait(1e-3);
                    Ok(Some(bytes.len()))
                }
                Some(Broken) => Err("cable"),
                Some(Quiet) | None => {
                    self.clock.wait(wait.as_secs_f64());
                    Ok(None)
                }
            }
        }
        fn reconnect(&mut self) -> Result<(), Self::Error> {
            let mut tried = self.tried.take();
            tried.push(self.clock.now());
            self.tried.set(tried);
            if self.reconnects.pop_front().unwrap_or(true) { Ok(()) } else { Err("still no cable") }
        }
    }

    /// Each byte is a sample; 255 is faulty, 0 has nothing to tell. Starts once.
    #[derive(Default)]
    struct Letters {
        counters: LinkCounters,
        started: bool,
    }

    impl Protocol for Letters {
        fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>> {
            loop {
                let (&first, rest) = bytes.split_first()?;
                *bytes = rest;
                if first == 255 {
                    self.counters.malformed += 1;
                    return Some(Err(FrameFault::Marker { at: 0, found: 255, expected: 1 }));
                } else if first > 0 {
                    self.counters.samples += 1;
                    return Some(Ok(RawSample::new(now, Channels::from([f64::from(first)]))));
                }
            }
        }
        fn request(&mut self, _: f64) -> Option<Request> {
            (!core::mem::replace(&mut self.started, true)).then(|| [1].into())
        }
        fn farewell(&self) -> Option<Request> {
            Some([0].into())
        }
        fn reset(&mut self) {
            self.started = false;
        }
        fn counters(&self) -> LinkCounters {
            self.counters
        }
    }

    struct Bench {
        link: Link<Script, Letters, Manual>,
        clock: Manual,
        tried: Rc<Cell<Vec<f64>>>,
        sent: Rc<Cell<usize>>,
    }

    fn bench(settings: LinkSettings, events: impl IntoIterator<Item = Event>, reconnects: &[bool]) -> Bench {
        let (clock, tried, sent) = (Manual::default(), Rc::default(), Rc::default());
        let script = Script {
            clock: clock.clone(),
            events: events.into_iter().collect(),
            reconnects: reconnects.iter().copied().collect(),
            tried: Rc::clone(&tried),
            sent: Rc::clone(&sent),
        };
        Bench { link: Link::new(script, Letters::default(), clock.clone(), settings), clock, tried, sent }
    }

    impl Bench {
        /// The next sample's value and flags.
        fn sample(&mut self) -> (f64, Quality) {
            let raw = self.link.next().unwrap().unwrap();
            (raw.channels[0], raw.quality)
        }
    }

    #[test]
    fn samples_of_one_buffer_with_their_time_of_arrival() {
        let mut bench = bench(LinkSettings::default(), [Bytes(&[1, 2]), Quiet, Bytes(&[3])], &[]);
        let times: Vec<f64> = bench.link.by_ref().take(2).map(|raw| raw.unwrap().host_time).collect();
        assert_eq!(times, [1e-3, 1e-3]);
        assert_eq!(bench.sample(), (3.0, Quality::empty()));
        assert_eq!((bench.link.counters().samples, bench.link.counters().requests, bench.sent.get()), (3, 1, 1));
    }

    #[test]
    fn answers_at_its_deadline_and_may_be_asked_again() {
        let mut bench = bench(LinkSettings { deadline: 0.12, ..LinkSettings::default() }, [Bytes(&[0])], &[]);
        for _ in 0..2 {
            let since = bench.clock.now();
            let error = bench.link.next().unwrap().unwrap_err();
            let waited = bench.clock.now() - since;
            assert!((waited - 0.12).abs() < 1e-9, "{waited}");
            let text = error.to_string();
            assert!(text.starts_with("no sample within 0.120 s (0 samples); is the device on"), "{text}");
        }
        bench.link.transport.events.push_back(Bytes(&[7]));
        assert_eq!(bench.sample(), (7.0, Quality::empty()));
    }

    #[test]
    fn a_deadline_that_is_no_number_has_passed() {
        let mut bench = bench(LinkSettings { deadline: f64::NAN, ..LinkSettings::default() }, [Bytes(&[1])], &[]);
        assert!(matches!(bench.link.next(), Some(Err(LinkError::Timeout { .. }))));
    }

    #[test]
    fn a_stream_of_nothing_does_not_hold_it_up() {
        let settings = LinkSettings { deadline: 0.5, ..LinkSettings::default() };
        let mut bench = bench(settings, (0..10_000).map(|_| Bytes(&[0, 0, 0])), &[]);
        assert!(matches!(bench.link.next(), Some(Err(LinkError::Timeout { .. }))));
        assert!(bench.clock.now() < 0.502);
    }

    #[test]
    fn a_storm_is_told_and_over() {
        let settings = LinkSettings { storm: 3, ..LinkSettings::default() };
        let mut bench = bench(settings, [Bytes(&[255, 255, 1, 255, 255]), Bytes(&[255, 255, 2])], &[]);
        assert_eq!(bench.sample().0, 1.0);
        let error = bench.link.next().unwrap().unwrap_err();
        assert!(matches!(error, LinkError::Storm { count: 3, .. }), "{error}");
        assert!(error.to_string().starts_with("3 faulty frames in a row, the last: a frame with 0xff at byte 0"));
        assert_eq!(bench.sample().0, 2.0);
        assert_eq!(bench.link.counters().malformed, 6);
    }

    #[test]
    fn broken_told_once_then_made_anew_and_flagged() {
        let mut bench = bench(LinkSettings::default(), [Bytes(&[1]), Broken, Bytes(&[2, 3])], &[false, true]);
        assert_eq!(bench.sample(), (1.0, Quality::empty()));
        assert_eq!(bench.link.next(), Some(Err(LinkError::Broken("cable"))));
        let flags = Quality::GAP_BEFORE | Quality::RESTARTED;
        assert_eq!((bench.sample(), bench.sample()), ((2.0, flags), (3.0, Quality::empty())));
        let counters = bench.link.counters();
        // started again, too
        assert_eq!((counters.reconnects, counters.requests), (1, 2));
        let tried = bench.tried.take();
        assert_eq!(tried.len(), 2);
        assert!((tried[0] - 0.251).abs() < 1e-9 && (tried[1] - 0.751).abs() < 1e-9, "{tried:?}");
    }

    #[test]
    fn pauses_grow_until_samples_come() {
        let reconnect = Reconnect::After { first: 0.25, most: 1.0 };
        let settings = LinkSettings { deadline: 0.1, reconnect, ..LinkSettings::default() };
        // made anew each time, but nothing comes of it
        let mut bench = bench(settings, (0..5).map(|_| Broken).chain([Bytes(&[1]), Broken]), &[]);
        let mut broken = 0;
        while broken < 6 {
            let since = bench.clock.now();
            broken += usize::from(matches!(bench.link.next(), Some(Err(LinkError::Broken(_)))));
            assert!(bench.clock.now() - since < 0.1 + 1e-9);
        }
        let _ = bench.link.by_ref().take(5).count();
        let tried = bench.tried.take();
        let pauses: Vec<f64> = core::iter::once(0.0).chain(tried.clone()).zip(&tried).map(|(a, b)| b - a).collect();
        for (pause, expected) in pauses.iter().zip([0.25, 0.5, 1.0, 1.0, 1.0, 0.251]) {
            assert!((pause - expected).abs() < 1e-9, "{pauses:?}");
        }
        assert_eq!(pauses.len(), 6);
    }

    #[test]
    fn no_pause_is_still_a_breath() {
        let reconnect = Reconnect::After { first: 0.0, most: 0.0 };
        let mut bench = bench(LinkSettings { reconnect, ..LinkSettings::default() }, [Broken], &[false; 10_000]);
        assert!(bench.link.next().unwrap().is_err());
        assert!(matches!(bench.link.next(), Some(Err(LinkError::Timeout { .. }))));
        assert!(bench.tried.take().len() <= 1001);
    }

    #[test]
    fn ends_where_it_is_not_to_be_made_anew() {
        let settings = LinkSettings { reconnect: Reconnect::Never, ..LinkSettings::default() };
        let mut bench = bench(settings, [Bytes(&[1, 2]), Broken, Bytes(&[3])], &[]);
        assert_eq!((bench.sample().0, bench.sample().0), (1.0, 2.0));
        assert_eq!(bench.link.next(), Some(Err(LinkError::Broken("cable"))));
        assert_eq!((bench.link.next(), bench.link.next()), (None, None));
        assert_eq!(bench.tried.take(), []);
    }

    #[test]
    fn stops_when_told() {
        let mut bench = bench(LinkSettings::default(), [Bytes(&[1]), Bytes(&[2])], &[]);
        bench.sample();
        bench.link.stop().unwrap();
        assert_eq!((bench.link.next(), bench.sent.get()), (None, 2));
    }
}
