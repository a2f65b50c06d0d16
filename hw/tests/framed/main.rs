//! Framed sensors: known frames, damaged streams, a capture of a real device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod capture;
mod damage;
mod garbage;
mod vectors;

use rod_hw::fake::{FakeBota, FakeDevice, FakeGsv8, FakeOptoForce, FakeRobotiq};
use rod_hw::framed::{Bota, Framed, Gsv, GsvValues, Hx711, OptoForce, Profile, Robotiq};
use rod_hw::{FrameFault, Protocol, Quality, RawSample};

/// A protocol that tells how many bytes it holds.
trait Subject: Protocol {
    fn held(&self) -> usize;
}

impl<P: Profile> Subject for Framed<P> {
    fn held(&self) -> usize {
        self.held()
    }
}

/// A device, who reads it, and the length of its frames.
struct Kind {
    name: &'static str,
    device: Box<dyn FakeDevice>,
    subject: Box<dyn Subject>,
    length: usize,
    /// What comes before the first frame.
    preamble: &'static [u8],
}

impl Kind {
    fn frame(&mut self, values: &[f64]) -> Vec<u8> {
        let mut frame = Vec::new();
        self.device.measure(values, Quality::empty(), &mut frame);
        assert_eq!(frame.len(), self.length, "{}", self.name);
        frame
    }
}

const DELIMITER: [u8; 6] = [0x0d, 0x0a, 0x00, 0x00, 0xfd, 0x44];

/// Strain gauges at an Arduino, which is too simple for a fake of its own.
struct Arduino;

impl FakeDevice for Arduino {
    fn hear(&mut self, _: &[u8], _: &mut Vec<u8>) {}
    fn measure(&mut self, values: &[f64], _: Quality, frame: &mut Vec<u8>) {
        (0..6).for_each(|i| frame.extend((values.get(i).copied().unwrap_or_default() as f32).to_le_bytes()));
        frame.extend(DELIMITER);
    }
    fn restart(&mut self) {}
    fn is_sending(&self) -> bool {
        true
    }
    fn rate(&self) -> f64 {
        88.0
    }
}

/// All of them anew.
fn kinds() -> Vec<Kind> {
    fn kind(
        name: &'static str,
        device: impl FakeDevice + 'static,
        profile: impl Profile + 'static,
        length: usize,
    ) -> Kind {
        let preamble: &[u8] = if name == "hx711" { &DELIMITER } else { &[] };
        Kind { name, device: Box::new(device), subject: Box::new(Framed::new(profile)), length, preamble }
    }
    let gsv = |name, values, length| {
        kind(name, FakeGsv8::new(6, 100.0, values), Gsv { values, channels: Some(6), ..Gsv::default() }, length)
    };
    vec![
        gsv("gsv f32", GsvValues::F32, 28),
        gsv("gsv i24", GsvValues::I24, 22),
        gsv("gsv i16", GsvValues::I16, 16),
        kind("bota", FakeBota::new(800.0).with_time(u32::MAX - 100_000), Bota::default(), 37),
        kind("optoforce 3", FakeOptoForce::new(3).with_count(65_500), OptoForce::default(), 16),
        kind("optoforce 6", FakeOptoForce::new(6), OptoForce::default(), 22),
        kind("optoforce 12", FakeOptoForce::new(12), OptoForce::default(), 34),
        kind("robotiq", FakeRobotiq::new(), Robotiq, 16),
        kind("hx711", Arduino, Hx711::new(6).unwrap(), 30),
    ]
}

type Told = Vec<Result<RawSample, FrameFault>>;

/// What a protocol tells of bytes that come in pieces of these lengths, again and again.
fn tell(protocol: &mut (impl Protocol + ?Sized), mut bytes: &[u8], lengths: &[usize]) -> Told {
    let (mut told, mut lengths) = (Vec::new(), lengths.iter().cycle());
    while !bytes.is_empty() {
        let (mut piece, rest) = bytes.split_at(bytes.len().min(*lengths.next().unwrap()));
        while let Some(one) = protocol.decode(&mut piece, 0.0) {
            told.push(one);
        }
        assert!(piece.is_empty(), "all is consumed when there is nothing to tell");
        bytes = rest;
    }
    told
}

/// The samples of these.
fn samples(told: &Told) -> Vec<RawSample> {
    told.iter().filter_map(|one| one.as_ref().ok()).copied().collect()
}

/// Numbers that look random, the same every time.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 16
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next() as u8).collect()
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}
