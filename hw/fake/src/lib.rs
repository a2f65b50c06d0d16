#![doc = include_str!("../README.md")]
//!
//! [`FakeSensor`] has a [`FakeDevice`], which speaks a device's language, send what a source yields over any stream, and has it
//! fail by a [`Script`]. Over a pseudo-terminal (feature `pty`) it is a serial port for any program.
//!
//! [`FakeRdt`] is a sensor that speaks RDT over UDP.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod bota;
mod gsv8;
mod optoforce;
#[cfg(all(feature = "pty", unix))]
mod pty;
mod rdt;
mod robotiq;
mod script;
mod sensor;

pub use bota::FakeBota;
pub use gsv8::FakeGsv8;
pub use optoforce::FakeOptoForce;
#[cfg(all(feature = "pty", unix))]
pub use pty::{Pty, open_pty};
pub use rdt::{FakeRdt, FakeRdtAccount, FakeRdtSettings, RdtFault};
pub use robotiq::FakeRobotiq;
pub use script::{Fault, Script};
pub use sensor::{End, FakeSensor, Pace, Served};

use rod_hw::{Quality, SerialProfile};

/// The language of a device, seen from the device: bytes in, bytes out, no clock.
pub trait FakeDevice {
    /// Takes what the host sends, as it comes, and appends what the device answers.
    fn hear(&mut self, bytes: &[u8], answers: &mut Vec<u8>);

    /// Appends the frame of the next sample, with what the device says of it as far as it can. Its counter and clock go on.
    /// Values that are missing are 0, those too many are left out.
    fn measure(&mut self, values: &[f64], quality: Quality, frame: &mut Vec<u8>);

    /// Whether it sends by itself now.
    fn is_sending(&self) -> bool;

    /// How often it does, Hz.
    fn rate(&self) -> f64;

    /// It was switched off and on.
    fn restart(&mut self);

    /// Whether it was asked for a single sample, which is told once.
    fn take_single(&mut self) -> bool {
        false
    }
}

impl<D: FakeDevice + ?Sized> FakeDevice for Box<D> {
    fn hear(&mut self, bytes: &[u8], answers: &mut Vec<u8>) {
        (**self).hear(bytes, answers);
    }
    fn measure(&mut self, values: &[f64], quality: Quality, frame: &mut Vec<u8>) {
        (**self).measure(values, quality, frame);
    }
    fn is_sending(&self) -> bool {
        (**self).is_sending()
    }
    fn rate(&self) -> f64 {
        (**self).rate()
    }
    fn restart(&mut self) {
        (**self).restart();
    }
    fn take_single(&mut self) -> bool {
        (**self).take_single()
    }
}

/// So many values, zeros where there are none.
fn padded<const N: usize>(values: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or_default())
}

/// A device of six channels for a profile, at a rate (Hz) where that can be said to such a device.
///
/// ```
/// use rod_fake_sensor::of_profile;
/// use rod_hw::{Protocol, Quality, SerialProfile};
/// let (mut device, mut frame) = (of_profile(SerialProfile::Bota, 100.0), Vec::new());
/// device.measure(&[3.0, -2.0, 1.0, 0.5, 0.25, -0.125], Quality::empty(), &mut frame);
/// let sample = SerialProfile::Bota.protocol().decode(&mut &frame[..], 0.0).ok_or("a whole frame")??;
/// assert_eq!(sample.channels[1], -2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A profile that is not known here gets a Robotiq FT 300.
pub fn of_profile(profile: SerialProfile, rate: f64) -> Box<dyn FakeDevice + Send> {
    match profile {
        SerialProfile::Gsv8 | SerialProfile::Gsv6 => Box::new(FakeGsv8::new(6, rate)),
        SerialProfile::Bota => Box::new(FakeBota::new(rate)),
        SerialProfile::OptoForce => Box::new(FakeOptoForce::new(6)),
        _ => Box::new(FakeRobotiq::new()),
    }
}
