//! The contract of framed devices, on any stream.

use crate::{Choices, is_same};
use allocation_counter::measure;
use rod_fake_sensor::FakeDevice;
use rod_hw::device::framed::{Content, Framed, Framing, Head, LONGEST_FRAME, Profile, SetupStep};
use rod_hw::{FrameFault, Protocol, Quality, RawSample, Request};
use std::cell::Cell;

/// A profile whose good frames are counted.
struct Watched<P> {
    profile: P,
    frames: Cell<u64>,
    bytes: Cell<u64>,
}

impl<P> Watched<P> {
    fn new(profile: P) -> Self {
        Self { profile, frames: Cell::new(0), bytes: Cell::new(0) }
    }
}

impl<P: Profile> Framing for Watched<P> {
    fn head(&self, bytes: &[u8]) -> Head {
        self.profile.head(bytes)
    }
    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        self.profile.check(frame)
    }
}

impl<P: Profile> Profile for Watched<P> {
    fn content(&self, frame: &[u8]) -> Content {
        self.frames.set(self.frames.get() + 1);
        self.bytes.set(self.bytes.get() + frame.len() as u64);
        self.profile.content(frame)
    }
    fn setup(&self, step: usize) -> Option<SetupStep> {
        self.profile.setup(step)
    }
    fn farewell(&self) -> Option<Request> {
        self.profile.farewell()
    }
    fn counter_bits(&self) -> Option<u32> {
        self.profile.counter_bits()
    }
}

type Told = Option<Result<RawSample, FrameFault>>;

/// What was told so far, and of how many bytes.
#[derive(Default)]
struct Account {
    given: u64,
    told: u64,
    faults: u64,
    last: Option<(Option<u64>, Option<f64>)>,
}

impl Account {
    fn note(&mut self, told: &Result<RawSample, FrameFault>) {
        self.told += 1;
        match told {
            Ok(sample) => {
                let wrong = sample.channels.iter().any(|value| !value.is_finite());
                assert!(!wrong || sample.quality.contains(Quality::DEVICE_ERROR));
                if let Some((number, time)) = self.last {
                    assert!(sample.sequence.is_none() || sample.sequence > number);
                    assert!(sample.device_time.is_none() || sample.device_time >= time);
                }
                self.last = Some((sample.sequence, sample.device_time));
            }
            Err(FrameFault::Refused { .. }) => {}
            Err(_) => self.faults += 1,
        }
    }

    fn check<P: Profile>(&self, protocol: &Framed<Watched<P>>) {
        let counters = protocol.counters();
        let watched = protocol.profile();
        assert!(protocol.held() <= LONGEST_FRAME);
        assert_eq!(watched.bytes.get() + counters.skipped_bytes + protocol.held() as u64, self.given);
        let handed = counters.samples + counters.repeated + counters.reordered + counters.answers;
        assert_eq!(handed, watched.frames.get());
        assert_eq!(counters.malformed + counters.bad_checksum, self.faults);
        assert!(self.told <= self.given);
    }
}

/// Checks that counters account for every byte and frame, that the bytes one at a time are told as all at once, that no more
/// than a frame is held, and that nothing is allocated.
pub fn check<P: Profile + Copy>(profile: P, device: &mut dyn FakeDevice, mut choices: Choices<'_>) {
    let length = 1 + usize::from(choices.byte());
    let plan = choices.byte();
    let (with_frames, anew) = (plan & 1 != 0, usize::from(plan >> 1));
    let waits = [choices.wait(), choices.wait()];
    let stream = if with_frames { stream(device, choices) } else { choices.0.to_vec() };
    let (mut whole, mut single) = (Framed::new(Watched::new(profile)), Framed::new(Watched::new(profile)));
    let used = measure(|| {
        let (mut account, mut now) = (Account::default(), 0.0);
        for (i, piece) in stream.chunks(length).enumerate() {
            now += waits[i % 2];
            if i > 0 && i == anew {
                whole.reset();
                single.reset();
                assert_eq!(whole.held(), 0);
            }
            assert_eq!(whole.request(now), single.request(now));
            account.given += piece.len() as u64;
            let (mut bytes, mut ahead) = (piece, piece);
            while let Some(told) = whole.decode(&mut bytes, now) {
                account.note(&told);
                assert!(is_told(&told, next(&mut single, &mut ahead, now)));
            }
            assert!(bytes.is_empty(), "all is consumed when there is nothing to tell");
            assert!(next(&mut single, &mut ahead, now).is_none());
            assert_eq!(whole.counters(), single.counters());
            assert_eq!(whole.held(), single.held());
            account.check(&whole);
        }
    });
    assert_eq!(used.count_total, 0);
}

fn is_told(told: &Result<RawSample, FrameFault>, other: Told) -> bool {
    match (told, other) {
        (Ok(a), Some(Ok(b))) => is_same(a, &b),
        (Err(a), Some(Err(b))) => *a == b,
        _ => false,
    }
}

/// What is told next of these bytes, one at a time.
fn next<P: Profile>(protocol: &mut Framed<P>, bytes: &mut &[u8], now: f64) -> Told {
    let mut told = protocol.decode(&mut &[][..], now);
    while told.is_none() && !bytes.is_empty() {
        let (mut one, rest) = bytes.split_at(1);
        told = protocol.decode(&mut one, now);
        if one.is_empty() {
            *bytes = rest;
        }
    }
    told
}

/// Bytes as they are, but for two: one stands for a frame of the device, perhaps with a flipped bit, one for a restart.
fn stream(device: &mut dyn FakeDevice, mut choices: Choices<'_>) -> Vec<u8> {
    const FRAME: u8 = 0xee;
    const RESTART: u8 = 0xed;
    let mut stream = Vec::new();
    while !choices.is_empty() {
        match choices.byte() {
            FRAME => {
                let values = [(); 6].map(|()| 16.0 * f64::from(i8::from_be_bytes([choices.byte()])));
                let quality = Quality::from_bits_truncate(u16::from(choices.byte()));
                let start = stream.len();
                device.measure(&values, quality, &mut stream);
                let damage = usize::from(choices.byte());
                let frame = &mut stream[start..];
                if damage & 0x80 != 0 && !frame.is_empty() {
                    let at = (damage & 0x7f) % frame.len();
                    frame[at] ^= 1 << (damage % 8);
                }
            }
            RESTART => device.restart(),
            byte => stream.push(byte),
        }
    }
    stream
}
