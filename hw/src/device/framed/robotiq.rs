//! Robotiq FT 300 and FT 150.

use super::checked;
use super::profile::{Await, Content, Framing, Head, Profile, Reading, SetupStep};
use crate::link::{FrameFault, Request};
use crc::{CRC_16_MODBUS, Crc};

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MODBUS);

/// Write 0x0200 to register 410 of slave 9.
const START: [u8; 11] = [0x09, 0x10, 0x01, 0x9a, 0x00, 0x01, 0x02, 0x02, 0x00, 0xcd, 0xca];

/// So many FF stop it, whatever it does.
const STOP: [u8; 50] = [0xff; 50];

/// The stream of a Robotiq FT 300 or FT 150, 19,200 baud:
///
/// ```text
/// 20 4E  Fx Fy Fz i16, 10 mN  Mx My Mz i16, 1 mN m  CRC-16/MODBUS of all before    little-endian
/// ```
///
/// Channels: counts ([`SCALES`](Self::SCALES)), which are too coarse for thin rods. No counter, no time, no status.
///
/// ```
/// use rod_hw::Protocol;
/// use rod_hw::device::framed::{Framed, Robotiq};
/// let mut protocol = Framed::new(Robotiq);
/// let frame = [0x20, 0x4e, 0x7b, 0, 0x38, 0xfe, 0x15, 3, 0x0c, 0, 0xde, 0xff, 0x38, 0, 0xe4, 0x5d];
/// let sample = protocol.decode(&mut &frame[..], 0.0).ok_or("no sample")??;
/// assert!((sample.channels[1] * Robotiq::SCALES[1] + 4.56).abs() < 1e-12); // N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Robotiq;

impl Robotiq {
    /// One count, N and N m.
    pub const SCALES: [f64; 6] = [1e-2, 1e-2, 1e-2, 1e-3, 1e-3, 1e-3];
}

impl Framing for Robotiq {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [0x20 | 0x09] => Head::Open,
            [0x20, 0x4e, ..] => Head::Length(16),
            // what it answers to the start, and to one that it refuses
            [0x09, 0x10, ..] => Head::Length(8),
            [0x09, 0x90, ..] => Head::Length(5),
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        checked(frame, u16::from_le_bytes, |bytes| CRC.checksum(bytes))
    }
}

impl Profile for Robotiq {
    fn content(&self, frame: &[u8]) -> Content {
        match frame[1] {
            0x4e => {
                let counts = frame[2..14].as_chunks().0.iter().map(|word| i16::from_le_bytes(*word).into());
                Content::Sample(Reading::new(super::channels(counts)))
            }
            0x90 => Content::Refusal(frame[2]),
            _ => Content::Answer,
        }
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        match step {
            // it hears no request while it sends
            0 => Some(SetupStep { request: STOP.into(), command: 0xff, until: Await::Pause(0.1) }),
            1 => Some(SetupStep { request: START.into(), command: 0x10, until: Await::Sample }),
            _ => None,
        }
    }

    fn farewell(&self) -> Option<Request> {
        Some(STOP.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_is_modbus() {
        assert_eq!(CRC.checksum(b"123456789"), 0x4b37);
        assert_eq!(CRC.checksum(&START[..9]).to_le_bytes(), START[9..]);
    }
}
