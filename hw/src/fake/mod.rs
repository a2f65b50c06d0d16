//! Devices that are programs: what a user tests with who has no sensor at hand, or not one that fails on demand.
//!
//! [`FakeSensor`] has a [`FakeDevice`], which speaks a device's language, send what a source yields over any stream, and has it
//! fail by a [`Script`]. Over a pseudo-terminal (feature `serial`) it is a serial port for any program.

mod bota;
mod gsv8;
mod optoforce;
mod robotiq;
mod script;
mod sensor;

pub use bota::FakeBota;
pub use gsv8::FakeGsv8;
pub use optoforce::FakeOptoForce;
pub use robotiq::FakeRobotiq;
pub use script::{Fault, Script};
pub use sensor::{End, FakeSensor, Pace, Served};

use crate::quality::Quality;

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
