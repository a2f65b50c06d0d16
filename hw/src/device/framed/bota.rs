//! Bota Systems SensONE, Rokubi.

use super::profile::{Content, Framing, Head, Profile, Reading};
use super::{checked, part};
use crate::link::FrameFault;
use crate::sample::Quality;
use crc::{CRC_16_IBM_SDLC, Crc};

/// X.25: polynomial 0x1021 reflected, begins with FFFF, inverted.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);

/// Bytes of a frame.
const LENGTH: usize = 37;

/// Frames of a Bota Systems sensor with a serial line, 460,800 baud:
///
/// ```text
/// AA  status u16  Fx Fy Fz Mx My Mz f32  time u32, us  temperature f32, C  CRC-16/X.25 of all but the first byte
/// status  bit 0 took too long, 1 overrange, 2 invalid, 3 uncalibrated        little-endian
/// ```
///
/// Channels: N and N m. Device time: unwrapped. Overrange is [`Quality::SATURATED`]; invalid and uncalibrated are
/// [`Quality::DEVICE_ERROR`]; anything else, a warning. There is no counter: samples that are missing show in the device
/// time. The sensor sends by itself; nothing is set up. See [`Framed`](super::Framed) for an example.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bota;

impl Framing for Bota {
    fn head(&self, bytes: &[u8]) -> Head {
        if bytes.first() == Some(&0xaa) { Head::Length(LENGTH) } else { Head::Other }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        checked(&frame[1..], u16::from_le_bytes, |bytes| CRC.checksum(bytes))
    }
}

impl Profile for Bota {
    fn content(&self, frame: &[u8]) -> Content {
        let status = u16::from_le_bytes(part(frame, 1));
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & 0b10 != 0);
        quality.set(Quality::DEVICE_ERROR, status & 0b1100 != 0);
        quality.set(Quality::DEVICE_WARNING, status & !0b1110 != 0);
        let float = |four: [u8; 4]| f64::from(f32::from_le_bytes(four));
        Content::Sample(Reading {
            status: status.into(),
            quality,
            temperature: Some(float(part(frame, 31))).filter(|celsius| celsius.is_finite()),
            microseconds: Some(u32::from_le_bytes(part(frame, 27))),
            ..Reading::new(super::channels(frame[3..27].as_chunks().0.iter().copied().map(float)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::framed::Framed;
    use crate::link::Protocol;

    #[test]
    fn checksum_is_x25() {
        assert_eq!(CRC.checksum(b"123456789"), 0x906e);
    }

    fn frame(status: u16, microseconds: u32) -> [u8; LENGTH] {
        let mut frame = [0; LENGTH];
        frame[0] = 0xaa;
        frame[1..3].copy_from_slice(&status.to_le_bytes());
        frame[27..31].copy_from_slice(&microseconds.to_le_bytes());
        let check = CRC.checksum(&frame[1..35]);
        frame[35..].copy_from_slice(&check.to_le_bytes());
        frame
    }

    #[test]
    fn status_and_time() {
        let mut protocol = Framed::new(Bota);
        let mut told = |status, microseconds| {
            let sample = protocol.decode(&mut &frame(status, microseconds)[..], 0.0).unwrap().unwrap();
            (sample.device_time.unwrap(), sample.quality)
        };
        let start = u32::MAX - 1499;
        let from = f64::from(start) * 1e-6;
        assert_eq!(told(0, start), (from, Quality::empty()));
        let (time, quality) = told(0b10, start.wrapping_add(2500));
        assert!((time - from - 2.5e-3).abs() < 1e-9 && quality == Quality::SATURATED, "{time} {quality}");
        assert_eq!(told(0b100, 2000).1, Quality::DEVICE_ERROR);
        assert_eq!(told(0b1000, 3000).1, Quality::DEVICE_ERROR);
        assert_eq!(told(1, 4000).1, Quality::DEVICE_WARNING);
        let (time, quality) = told(0, 10);
        assert!((time - from - 5.5e-3).abs() < 1e-9, "{time}");
        assert_eq!(quality, Quality::GAP_BEFORE | Quality::RESTARTED, "switched off and on");
        assert_eq!((protocol.counters().restarts, protocol.counters().device_errors), (1, 3));
    }
}
