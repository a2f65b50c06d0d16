//! Sensors on a serial line whose bytes are frames: sync, length, check.
//!
//! One protocol, [`Framed`], for any [`Profile`]:
//!
//! | profile | devices | check | number, time | channels |
//! |---|---|---|---|---|
//! | [`Gsv`] | ME-Messsysteme GSV-8, GSV-6 | terminator only | none | up to 16, f32 in the unit of the device |
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
mod gsv;
mod optoforce;
mod profile;
mod protocol;
mod robotiq;
mod scanner;

pub use bota::Bota;
pub use gsv::Gsv;
pub use optoforce::OptoForce;
pub use profile::{Await, Content, Framing, Head, Profile, Reading, SetupStep};
pub use protocol::Framed;
pub use robotiq::Robotiq;
pub use scanner::{LONGEST_FRAME, Scanner};

use crate::link::FrameFault;
use crate::sample::Channels;

/// Compares the last two bytes of a frame with the check of the bytes before.
fn checked(frame: &[u8], word: fn([u8; 2]) -> u16, check: impl Fn(&[u8]) -> u16) -> Result<(), FrameFault> {
    let (bytes, sent) = frame.split_last_chunk().unwrap_or((frame, &[0; 2]));
    let (found, expected) = (word(*sent), check(bytes));
    if found == expected { Ok(()) } else { Err(FrameFault::Checksum { found, expected }) }
}

/// Some bytes of a frame whose length is checked; zeros beyond its end.
fn part<const N: usize>(frame: &[u8], at: usize) -> [u8; N] {
    frame.get(at..).and_then(|rest| rest.first_chunk()).copied().unwrap_or([0; N])
}

/// The values that there are, at most as many as fit.
fn channels(values: impl Iterator<Item = f64>) -> Channels {
    let (mut all, mut count) = ([0.0; Channels::MOST], 0);
    for (place, value) in all.iter_mut().zip(values) {
        *place = value;
        count += 1;
    }
    Channels::new(&all[..count]).unwrap_or_default()
}
