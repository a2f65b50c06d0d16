//! Framed sensors: known frames, damaged streams, a capture of a real device.

mod capture;
mod damage;
mod garbage;
mod vectors;

use rod_fake_sensor::{FakeBota, FakeDevice, FakeGsv8, FakeOptoForce, FakeRobotiq};
use rod_hw::device::framed::{Bota, Framed, Gsv, OptoForce, Profile, Robotiq};
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
}

impl Kind {
    fn frame(&mut self, values: &[f64]) -> Vec<u8> {
        let mut frame = Vec::new();
        self.device.measure(values, Quality::empty(), &mut frame);
        assert_eq!(frame.len(), self.length, "{}", self.name);
        frame
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
        Kind { name, device: Box::new(device), subject: Box::new(Framed::new(profile)), length }
    }
    vec![
        kind("gsv", FakeGsv8::new(6, 100.0), Gsv, 28),
        kind("bota", FakeBota::new(800.0).with_time(u32::MAX - 100_000), Bota, 37),
        kind("optoforce 3", FakeOptoForce::new(3).with_count(65_500), OptoForce, 16),
        kind("optoforce 6", FakeOptoForce::new(6), OptoForce, 22),
        kind("optoforce 12", FakeOptoForce::new(12), OptoForce, 34),
        kind("robotiq", FakeRobotiq::new(), Robotiq, 16),
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
