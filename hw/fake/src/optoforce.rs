//! An OptoForce sensor that is a program.

use super::FakeDevice;
use rod_hw::device::framed::{Framing, Head, Scanner};
use rod_hw::{FrameFault, Quality};

/// An OptoForce sensor with the USB converter, at first sending at 100 Hz: it hears rate and stop. Values are counts.
///
/// ```
/// use rod_hw::Quality;
/// use rod_fake_sensor::{FakeDevice, FakeOptoForce};
/// let (mut device, mut bytes) = (FakeOptoForce::new(3), Vec::new());
/// device.measure(&[100.0, -2.0, 0.0], Quality::empty(), &mut bytes);
/// assert_eq!(bytes, [0xaa, 7, 8, 10, 0, 0, 0, 0, 0, 100, 0xff, 0xfe, 0, 0, 3, 0x24]);
/// ```
#[derive(Clone, Debug)]
pub struct FakeOptoForce {
    channels: u8,
    count: u16,
    period: u8,
    scanner: Scanner,
}

impl FakeOptoForce {
    /// A sensor of 3, 6 or 12 channels: the next of these where it is another number.
    pub fn new(channels: usize) -> Self {
        let channels = if channels <= 3 {
            3
        } else if channels <= 6 {
            6
        } else {
            12
        };
        Self { channels, count: 0, period: 10, scanner: Scanner::default() }
    }

    /// With its counter here.
    #[must_use]
    pub fn with_count(mut self, count: u16) -> Self {
        self.count = count;
        self
    }
}

impl FakeDevice for FakeOptoForce {
    fn hear(&mut self, mut bytes: &[u8], answers: &mut Vec<u8>) {
        while let Some(request) = self.scanner.next(&mut bytes, &Requests) {
            if let Ok([_, _, _, _, speed, ..]) = request {
                self.period = *speed;
                answers.extend([0xaa, 0, 0x50, 1, 0, 0, 0xfb]);
            }
        }
    }

    fn measure(&mut self, values: &[f64], quality: Quality, frame: &mut Vec<u8>) {
        let flags = [(Quality::DEVICE_WARNING, 1), (Quality::SATURATED, 1 << 4), (Quality::DEVICE_ERROR, 1 << 11)];
        let status: u16 = flags.into_iter().filter(|(flag, _)| quality.contains(*flag)).map(|(_, bit)| bit).sum();
        let mut bytes = vec![0xaa, 7, 8, 2 * self.channels + 4];
        bytes.extend(self.count.to_be_bytes());
        bytes.extend(status.to_be_bytes());
        for i in 0..usize::from(self.channels) {
            let count = values.get(i).copied().unwrap_or_default().round() as i16;
            bytes.extend(count.to_be_bytes());
        }
        let sum = sum(&bytes);
        bytes.extend(sum.to_be_bytes());
        frame.extend(bytes);
        self.count = self.count.wrapping_add(1);
    }

    fn restart(&mut self) {
        *self = Self::new(self.channels.into());
    }

    fn is_sending(&self) -> bool {
        self.period > 0
    }

    fn rate(&self) -> f64 {
        1000.0 / f64::from(self.period.max(1))
    }
}

/// The requests of the host.
struct Requests;

impl Framing for Requests {
    fn head(&self, bytes: &[u8]) -> Head {
        const REQUEST: [u8; 4] = [0xaa, 0, 0x32, 3];
        match bytes {
            _ if bytes.iter().zip(REQUEST).any(|(a, b)| *a != b) => Head::Other,
            [_, _, _, _, ..] => Head::Length(9),
            _ => Head::Open,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let (bytes, check) = frame.split_at(7);
        let (found, expected) = (u16::from_be_bytes([check[0], check[1]]), sum(bytes));
        if found == expected { Ok(()) } else { Err(FrameFault::Checksum { found, expected }) }
    }
}

/// Sum of bytes, which wraps.
fn sum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_add(u16::from(*byte)))
}
