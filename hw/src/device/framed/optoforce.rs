//! OptoForce and OnRobot sensors with the USB converter.

use super::profile::{Content, Framing, Head, Profile, Reading};
use super::{checked, part};
use crate::link::FrameFault;
use crate::sample::Quality;

/// Frames of an OptoForce sensor of 3, 6 or 4 times 3 axes, 1,000,000 baud:
///
/// ```text
/// AA 07 08  length u8  count u16  status u16  3, 6 or 12 counts i16  sum u16 of all bytes before    big-endian
/// status  bits 4 to 9 overload, 10 to 12 sensor error, 13 to 15 converter error
/// ```
///
/// Channels: counts; how many there are to a newton is in the sensor's sensitivity report. Overload is
/// [`Quality::SATURATED`], errors are [`Quality::DEVICE_ERROR`]. A sum of bytes does not detect bytes in another order.
///
/// The sensor sends by itself; nothing is set up.
///
/// ```
/// use rod_hw::Protocol;
/// use rod_hw::device::framed::{Framed, OptoForce};
/// let mut protocol = Framed::new(OptoForce);
/// let bytes = [0xaa, 7, 8, 10, 0, 1, 0, 0, 0, 100, 0xff, 0xfe, 0, 0, 3, 0x25];
/// let sample = protocol.decode(&mut &bytes[..], 0.0).ok_or("no sample")??;
/// assert_eq!((sample.sequence, &sample.channels[..]), (Some(1), &[100.0, -2.0, 0.0][..]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OptoForce;

impl Framing for OptoForce {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [0xaa] | [0xaa, 7] | [0xaa, 7, 8] => Head::Open,
            // 2 more for the sum
            [0xaa, 7, 8, length @ (10 | 16 | 28), ..] => Head::Length(usize::from(length) + 6),
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        checked(frame, u16::from_be_bytes, |bytes| {
            bytes.iter().fold(0, |sum: u16, byte| sum.wrapping_add((*byte).into()))
        })
    }
}

impl Profile for OptoForce {
    fn content(&self, frame: &[u8]) -> Content {
        let status = u16::from_be_bytes(part(frame, 6));
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & 0x03f0 != 0);
        quality.set(Quality::DEVICE_ERROR, status & 0xfc00 != 0);
        quality.set(Quality::DEVICE_WARNING, status & 0x000f != 0 && status & 0xfff0 == 0);
        let counts = frame[8..frame.len() - 2].as_chunks().0.iter().map(|word| i16::from_be_bytes(*word).into());
        Content::Sample(Reading {
            status: status.into(),
            quality,
            number: Some(u16::from_be_bytes(part(frame, 4)).into()),
            ..Reading::new(super::channels(counts))
        })
    }

    fn counter_bits(&self) -> Option<u32> {
        Some(16)
    }
}
