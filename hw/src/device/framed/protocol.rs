//! The protocol of all framed sensors.

use super::profile::{Await, Content, Profile, Reading, SetupStep};
use super::scanner::Scanner;
use crate::link::{FrameFault, LinkCounters, Protocol, Request, Sequence, SequenceStep};
use crate::sample::{Quality, RawSample};

/// Time after which a request without answer is sent again, s: longer than any of these devices takes.
const RETRY: f64 = 0.5;

/// Silence after which a device is set up again, s: it may have been switched off and on.
const SILENCE: f64 = 2.0;

/// A framed device as a [`Protocol`], for a [`Link`](crate::Link).
///
/// Where the device does not number its samples, one after skipped bytes is flagged [`Quality::GAP_BEFORE`]; one with a value
/// that is not a finite number, [`Quality::DEVICE_ERROR`]. A device that was silent for 2 s is set up again; the first sample
/// after that is [`Quality::RESTARTED`].
///
/// ```
/// use rod_hw::Protocol;
/// use rod_hw::device::framed::{Bota, Framed};
/// let mut protocol = Framed::new(Bota);
/// let mut bytes: &[u8] = &[
///     0xaa, 0, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f, 0x0a, 0xd7, 0x23, 0x3c, 0x0a, 0xd7, 0xa3, 0xbc, 0xa6, 0x9b,
///     0x44, 0x3b, 0x40, 0xe2, 1, 0, 0, 0, 0xfc, 0x41, 0xd2, 0xd3,
/// ];
/// let sample = protocol.decode(&mut bytes, 7.5).ok_or("no frame")??;
/// assert_eq!(sample.channels[..3], [1.0, -2.0, 0.5]); // N
/// assert_eq!((sample.device_time, sample.temperature), (Some(0.123456), Some(31.5)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Framed<P> {
    profile: P,
    scanner: Scanner,
    setup: Setup,
    sequence: Option<Sequence>,
    /// Offset that is added to the counter, which may restart.
    base: u64,
    number: Option<u64>,
    clock: Clock,
    /// Skipped bytes, when the last sample came.
    skipped: u64,
    counters: LinkCounters,
    /// For the next sample.
    flags: Quality,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Setup {
    /// This step is to be sent, not before a time.
    Due { step: usize, at: f64 },
    /// It was sent, and what it waits for did not come.
    Sent { step: usize, at: f64 },
    /// Nothing more to do; since when no samples came although asked for.
    Done { quiet: Option<f64> },
}

/// Microseconds of 32 bits, unwrapped.
#[derive(Clone, Copy, Debug, Default)]
struct Clock {
    last: Option<u32>,
    total: u64,
}

impl Clock {
    /// Goes on to a time, s. Whether that was forwards.
    fn step(&mut self, microseconds: u32) -> bool {
        let ahead = self.last.map_or(microseconds, |last| microseconds.wrapping_sub(last));
        let forwards = self.last.is_none() || ahead <= u32::MAX / 2;
        if forwards {
            self.total += u64::from(ahead);
        }
        self.last = Some(microseconds);
        forwards
    }
}

impl<P: Profile> Framed<P> {
    /// Ready for the first byte.
    pub fn new(profile: P) -> Self {
        Self {
            sequence: sequence(&profile),
            profile,
            scanner: Scanner::default(),
            setup: Setup::Due { step: 0, at: f64::NEG_INFINITY },
            base: 0,
            number: None,
            clock: Clock::default(),
            skipped: 0,
            counters: LinkCounters::default(),
            flags: Quality::empty(),
        }
    }

    /// The profile.
    pub fn profile(&self) -> &P {
        &self.profile
    }

    /// Bytes of a frame that is not whole yet: the bytes that came are those of good frames, the skipped ones, and these.
    pub fn held(&self) -> usize {
        self.scanner.held()
    }

    /// Ends a wait for this event.
    fn came(&mut self, what: Await, now: f64) {
        if let Setup::Sent { step, .. } = self.setup
            && self.profile.setup(step).is_some_and(|sent| sent.until == what)
        {
            self.setup = Setup::Due { step: step + 1, at: now };
        }
    }

    /// The sample, unless it is to be left out.
    fn sample(&mut self, reading: Reading, now: f64) -> Option<RawSample> {
        self.came(Await::Sample, now);
        if let Setup::Done { quiet } = &mut self.setup {
            *quiet = None;
        }
        let mut device_time = None;
        if let (Some(sequence), Some(number)) = (&mut self.sequence, reading.number) {
            match sequence.step(number) {
                SequenceStep::First => {
                    let least = self.number.map_or(0, |last| last + 1);
                    self.base = least.saturating_sub(sequence.unwrapped());
                }
                SequenceStep::Next => {}
                SequenceStep::Gap(missing) => {
                    self.counters.gaps += 1;
                    self.counters.lost += u64::from(missing);
                    self.flags |= Quality::GAP_BEFORE;
                }
                SequenceStep::Repeated => {
                    self.counters.repeated += 1;
                    return None;
                }
                SequenceStep::Late => {
                    self.counters.reordered += 1;
                    return None;
                }
                SequenceStep::Restarted => {
                    self.counters.restarts += 1;
                    self.flags |= Quality::GAP_BEFORE | Quality::RESTARTED;
                }
            }
            let number = self.base + sequence.unwrapped();
            self.number = Some(number);
        } else if self.counters.samples > 0 && self.scanner.skipped() > self.skipped {
            self.flags |= Quality::GAP_BEFORE;
        }
        if let Some(microseconds) = reading.microseconds {
            if !self.clock.step(microseconds) {
                self.counters.restarts += 1;
                self.flags |= Quality::GAP_BEFORE | Quality::RESTARTED;
            }
            device_time = Some(self.clock.total as f64 * 1e-6);
        }
        let mut quality = reading.quality | core::mem::take(&mut self.flags);
        if !reading.channels.iter().all(|value| value.is_finite()) {
            quality |= Quality::DEVICE_ERROR;
        }
        self.skipped = self.scanner.skipped();
        self.counters.samples += 1;
        self.counters.device_errors += u64::from(quality.intersects(Quality::SATURATED | Quality::DEVICE_ERROR));
        Some(RawSample {
            sequence: self.sequence.is_some().then_some(self.number).flatten(),
            device_time,
            host_time: now,
            status: reading.status,
            temperature: reading.temperature,
            channels: reading.channels,
            quality,
        })
    }

    /// Counts an answer, and tells of a refusal of what is being waited for.
    fn answer(&mut self, refusal: Option<u8>, now: f64) -> Option<FrameFault> {
        self.counters.answers += 1;
        let Some(code) = refusal else {
            self.came(Await::Answer, now);
            return None;
        };
        let Setup::Sent { step, .. } = self.setup else { return None };
        self.profile.setup(step).map(|SetupStep { command: request, .. }| FrameFault::Refused { request, code })
    }
}

fn sequence(profile: &impl Profile) -> Option<Sequence> {
    profile.counter_bits().map(Sequence::new)
}

impl<P: Profile> Protocol for Framed<P> {
    fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>> {
        loop {
            let content = match self.scanner.next(bytes, &self.profile)? {
                Ok(frame) => self.profile.content(frame),
                Err(fault) => {
                    match fault {
                        FrameFault::Checksum { .. } => self.counters.bad_checksum += 1,
                        _ => self.counters.malformed += 1,
                    }
                    return Some(Err(fault));
                }
            };
            let told = match content {
                Content::Sample(reading) => self.sample(reading, now).map(Ok),
                Content::Answer => self.answer(None, now).map(Err),
                Content::Refusal(code) => self.answer(Some(code), now).map(Err),
            };
            if told.is_some() {
                return told;
            }
        }
    }

    fn request(&mut self, now: f64) -> Option<Request> {
        let step = match &mut self.setup {
            Setup::Due { step, at } if now >= *at => *step,
            Setup::Sent { step, at } if now - *at >= RETRY => *step,
            // that nobody asked for samples is no silence of the device
            Setup::Done { quiet: quiet @ None } => {
                *quiet = Some(now);
                return None;
            }
            Setup::Done { quiet: Some(since) } if now - *since >= SILENCE => {
                self.flags |= Quality::GAP_BEFORE | Quality::RESTARTED;
                0
            }
            _ => return None,
        };
        let Some(SetupStep { request, until, .. }) = self.profile.setup(step) else {
            self.setup = Setup::Done { quiet: Some(now) };
            return None;
        };
        self.setup = match until {
            Await::Pause(pause) => Setup::Due { step: step + 1, at: now + pause },
            _ => Setup::Sent { step, at: now },
        };
        Some(request)
    }

    fn farewell(&self) -> Option<Request> {
        self.profile.farewell()
    }

    fn reset(&mut self) {
        self.scanner.reset();
        self.sequence = sequence(&self.profile);
        self.setup = Setup::Due { step: 0, at: f64::NEG_INFINITY };
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters { skipped_bytes: self.scanner.skipped(), ..self.counters }
    }
}
