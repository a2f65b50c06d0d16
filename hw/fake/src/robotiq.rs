//! A Robotiq FT 300 that is a program.

use super::{FakeDevice, padded};
use crc::{CRC_16_MODBUS, Crc};
use rod_hw::device::framed::{Framing, Head, Robotiq, Scanner};
use rod_hw::{FrameFault, Quality};

/// Of Modbus.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MODBUS);

/// A Robotiq FT 300, 100 Hz: it hears start and stop. Values are N and N m; of their quality it says nothing.
///
/// ```
/// use rod_hw::Quality;
/// use rod_fake_sensor::{FakeDevice, FakeRobotiq};
/// let (mut device, mut bytes) = (FakeRobotiq::new(), Vec::new());
/// device.hear(&[0x09, 0x10, 0x01, 0x9a, 0x00, 0x01, 0x02, 0x02, 0x00, 0xcd, 0xca], &mut bytes);
/// assert!(device.is_sending());
/// bytes.clear();
/// device.measure(&[1.23, -4.56, 7.89, 0.012, -0.034, 0.056], Quality::empty(), &mut bytes);
/// assert_eq!(bytes, [0x20, 0x4e, 0x7b, 0, 0x38, 0xfe, 0x15, 3, 0x0c, 0, 0xde, 0xff, 0x38, 0, 0xe4, 0x5d]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct FakeRobotiq {
    sending: bool,
    scanner: Scanner,
}

impl FakeRobotiq {
    /// A sensor that waits to be started.
    pub fn new() -> Self {
        Self::default()
    }
}

impl FakeDevice for FakeRobotiq {
    fn hear(&mut self, mut bytes: &[u8], answers: &mut Vec<u8>) {
        while let Some(request) = self.scanner.next(&mut bytes, &Requests) {
            match request {
                Ok([0xff]) => self.sending = false,
                // while it sends, it hears nothing but what stops it
                Ok([slave, function, high, low, ..]) if !self.sending => {
                    let is_start = [*high, *low] == [0x01, 0x9a];
                    let mut answer =
                        if is_start { vec![*slave, *function, 1, 0x9a, 0, 1] } else { vec![*slave, 0x90, 2] };
                    let check = CRC.checksum(&answer);
                    answer.extend(check.to_le_bytes());
                    answers.extend(answer);
                    self.sending = is_start;
                }
                _ => {}
            }
        }
    }

    fn measure(&mut self, values: &[f64], _: Quality, frame: &mut Vec<u8>) {
        let mut bytes = vec![0x20, 0x4e];
        for (value, scale) in padded::<6>(values).into_iter().zip(Robotiq::SCALES) {
            bytes.extend(((value / scale).round() as i16).to_le_bytes());
        }
        let check = CRC.checksum(&bytes);
        bytes.extend(check.to_le_bytes());
        frame.extend(bytes);
    }

    fn restart(&mut self) {
        *self = Self::new();
    }

    fn is_sending(&self) -> bool {
        self.sending
    }

    fn rate(&self) -> f64 {
        100.0
    }
}

/// The requests of the host.
struct Requests;

impl Framing for Requests {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [0xff, ..] => Head::Length(1),
            [0x09, 0x10, _, _, _, _, count, ..] => Head::Length(9 + usize::from(count)),
            [0x09] | [0x09, 0x10, ..] => Head::Open,
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let Some((bytes, check)) = frame.split_last_chunk::<2>().filter(|_| frame.len() > 1) else { return Ok(()) };
        let (found, expected) = (u16::from_le_bytes(*check), CRC.checksum(bytes));
        if found == expected { Ok(()) } else { Err(FrameFault::Checksum { found, expected }) }
    }
}
