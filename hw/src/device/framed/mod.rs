//! Sensors on a serial line whose bytes are frames: sync, length, check.
//!
//! One engine, [`Framed`], for any [`Profile`]:
//!
//! | profile | devices | check | number, time | channels |
//! |---|---|---|---|---|
//! | [`Gsv`] | ME-Messsysteme GSV-8, GSV-6 | terminator only | none | up to 16: units (f32) or counts (16, 24 bit) |
//! | [`Bota`] | Bota Systems SensONE, Rokubi | CRC-16/X.25 | time, us | Fx Fy Fz Mx My Mz, N and N m |
//! | [`OptoForce`] | OptoForce, OnRobot by USB | sum of bytes | counter | 3, 6 or 12 counts |
//! | [`Robotiq`] | Robotiq FT 300, FT 150 | CRC-16/MODBUS | none | Fx to Mz, counts of 10 mN and 1 mN m |
//!
//! The layouts are those of the makers' published programs and manuals; that of OptoForce was checked with a recording of a real
//! sensor, that of the GSV with its maker's library at the other end. None of the devices was at hand.
//!
//! A device that is not there needs three functions and what it answers: see [`Profile`]. Without the feature `std` all of
//! it works, too, and allocates nothing.

mod bota;
mod engine;
pub mod gsv;
mod optoforce;
mod profile;
mod robotiq;
mod scanner;

pub use crate::device::onrobot_filter::OnRobotFilter as OptoForceFilter;
pub use bota::{Bota, BotaFilter};
pub use engine::Framed;
pub use gsv::{Gsv, GsvValues};
pub use optoforce::{OptoForce, OptoForceRate, OptoForceSetup};
pub use profile::{Await, Content, Counter, Framing, Head, Profile, Reading, SetupStep};
pub use robotiq::Robotiq;
pub use scanner::{LONGEST_FRAME, Scanner};

/// Words of two bytes.
fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; 2]> {
    bytes.chunks_exact(2).map(|pair| [pair[0], pair[1]])
}

/// Words of four bytes.
fn doubles(bytes: &[u8]) -> impl Iterator<Item = [u8; 4]> {
    bytes.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]])
}

/// Two bytes of a frame whose length is checked; zeros beyond its end.
fn word_at(frame: &[u8], at: usize) -> [u8; 2] {
    frame.get(at..at + 2).and_then(|bytes| bytes.try_into().ok()).unwrap_or_default()
}

/// Four bytes of a frame whose length is checked; zeros beyond its end.
fn double_at(frame: &[u8], at: usize) -> [u8; 4] {
    frame.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).unwrap_or_default()
}

/// The values that there are, at most as many as fit.
fn channels(values: impl Iterator<Item = f64>) -> crate::sample::Channels {
    let (mut all, mut count) = ([0.0; crate::sample::Channels::MOST], 0);
    for (place, value) in all.iter_mut().zip(values) {
        *place = value;
        count += 1;
    }
    crate::sample::Channels::new(&all[..count]).unwrap_or_default()
}

/// A request in words; empty where it is too long, which none of these is.
fn text(words: core::fmt::Arguments<'_>) -> crate::link::Request {
    use crate::link::Request;
    struct Line {
        bytes: [u8; Request::MOST],
        count: usize,
    }
    impl core::fmt::Write for Line {
        fn write_str(&mut self, text: &str) -> core::fmt::Result {
            let end = self.count + text.len();
            self.bytes.get_mut(self.count..end).ok_or(core::fmt::Error)?.copy_from_slice(text.as_bytes());
            self.count = end;
            Ok(())
        }
    }
    let mut line = Line { bytes: [0; Request::MOST], count: 0 };
    match core::fmt::write(&mut line, words) {
        Ok(()) => Request::new(&line.bytes[..line.count]).unwrap_or_else(|| [].into()),
        Err(_) => [].into(),
    }
}
