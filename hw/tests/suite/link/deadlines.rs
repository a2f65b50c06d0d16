//! Deadlines, reconnections and faults of a link.

use rod_hw::*;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Duration;

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
    events: Rc<RefCell<VecDeque<Event>>>,
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
        let event = self.events.borrow_mut().pop_front();
        match event {
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
    events: Rc<RefCell<VecDeque<Event>>>,
}

fn bench(settings: LinkSettings, events: impl IntoIterator<Item = Event>, reconnects: &[bool]) -> Bench {
    let (clock, tried, sent) = (Manual::default(), Rc::default(), Rc::default());
    let events = Rc::new(RefCell::new(events.into_iter().collect()));
    let script = Script {
        clock: clock.clone(),
        events: Rc::clone(&events),
        reconnects: reconnects.iter().copied().collect(),
        tried: Rc::clone(&tried),
        sent: Rc::clone(&sent),
    };
    Bench { link: Link::new(script, Letters::default(), clock.clone(), settings), clock, tried, sent, events }
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
    bench.events.borrow_mut().push_back(Bytes(&[7]));
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
    assert!(bench.tried.take().is_empty());
}

#[test]
fn stops_when_told() {
    let mut bench = bench(LinkSettings::default(), [Bytes(&[1]), Bytes(&[2])], &[]);
    bench.sample();
    bench.link.stop().unwrap();
    assert_eq!((bench.link.next(), bench.sent.get()), (None, 2));
}
