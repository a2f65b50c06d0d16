//! Bota Systems SensONE, Rokubi.

use super::profile::{Await, Content, Framing, Head, Profile, Reading, SetupStep};
use super::{double_at, word_at};
use crate::link::FrameFault;
use crate::sample::Quality;
use crc::{CRC_16_IBM_SDLC, Crc};

/// X.25: polynomial 0x1021 reflected, begins with FFFF, inverted.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);

/// Bytes of a frame.
pub(crate) const LENGTH: usize = 37;

/// Frames of a Bota Systems sensor with a serial line, 460,800 baud:
///
/// ```text
/// AA  status u16  Fx Fy Fz Mx My Mz f32  time u32, us  temperature f32, C  CRC-16/X.25 of all but the first byte
/// status  bit 0 took too long, 1 overrange, 2 invalid, 3 uncalibrated        little-endian
/// ```
///
/// Channels: N and N m. Device time: unwrapped. Overrange is [`Quality::SATURATED`]; invalid and uncalibrated are
/// [`Quality::DEVICE_ERROR`]; anything else, a warning. There is no counter: samples that are missing show in the device
/// time. See [`Framed`](super::Framed) for an example.
///
/// By [`Default`] it listens to what the sensor sends by itself. With a filter, it sets that up first (nothing is stored in
/// the sensor).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bota {
    /// The filter to set, if any.
    pub filter: Option<BotaFilter>,
}

/// The filter of a Bota sensor, which gives its rate.
///
/// ```
/// use rod_hw::device::framed::BotaFilter;
/// assert_eq!(BotaFilter { sinc: 512, ..BotaFilter::default() }.rate(), 100.0); // Hz
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BotaFilter {
    /// Length of the sinc filter, 51 to 8192.
    pub sinc: u16,
    /// Chopping, against offsets.
    pub chop: bool,
    /// Fast settling.
    pub fast: bool,
    /// The FIR filter behind it.
    pub fir: bool,
}

impl BotaFilter {
    /// Rate, Hz.
    pub fn rate(&self) -> f64 {
        51_200.0 / f64::from(self.sinc.max(1))
    }
}

impl Default for BotaFilter {
    /// 200 Hz, nothing else.
    fn default() -> Self {
        Self { sinc: 256, chop: false, fast: false, fir: false }
    }
}

/// The check of a frame's bytes between header and check.
pub(crate) fn checksum(bytes: &[u8]) -> u16 {
    CRC.checksum(bytes)
}

impl Framing for Bota {
    fn head(&self, bytes: &[u8]) -> Head {
        // an answer: r,0,<command>,<code>
        let is_answer = bytes.iter().zip(b"r,0,").all(|(a, b)| a == b) && bytes.get(5).is_none_or(|byte| *byte == b',');
        match bytes {
            [0xaa, ..] => Head::Length(LENGTH),
            _ if is_answer && bytes.len() < 6 => Head::Open,
            _ if is_answer => Head::Length(7),
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        if frame.len() < LENGTH {
            return Ok(());
        }
        let (found, expected) = (u16::from_le_bytes(word_at(frame, 35)), checksum(&frame[1..35]));
        if found == expected { Ok(()) } else { Err(FrameFault::Checksum { found, expected }) }
    }
}

impl Profile for Bota {
    fn content(&self, frame: &[u8]) -> Content {
        if frame.len() < LENGTH {
            return if frame[6] == b'0' { Content::Answer } else { Content::Refusal(frame[6]) };
        }
        let status = u16::from_le_bytes(word_at(frame, 1));
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & 0b10 != 0);
        quality.set(Quality::DEVICE_ERROR, status & 0b1100 != 0);
        quality.set(Quality::DEVICE_WARNING, status & !0b1110 != 0);
        let float = |four: [u8; 4]| f64::from(f32::from_le_bytes(four));
        Content::Sample(Reading {
            status: status.into(),
            quality,
            temperature: Some(float(double_at(frame, 31))).filter(|celsius| celsius.is_finite()),
            microseconds: Some(u32::from_le_bytes(double_at(frame, 27))),
            ..Reading::new(super::channels(super::doubles(&frame[3..27]).map(float)))
        })
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        let filter = self.filter?;
        let BotaFilter { sinc, chop, fast, fir } = filter;
        let [chop, fast, no_fir] = [chop, fast, !fir].map(u8::from);
        Some(match step {
            0 => SetupStep { request: [b'C'].into(), command: b'C', until: Await::Answer },
            1 => SetupStep {
                request: super::text(format_args!("f,{sinc},{chop},{fast},{no_fir}")),
                command: b'f',
                until: Await::Answer,
            },
            2 => SetupStep { request: [b'R'].into(), command: b'R', until: Await::Sample },
            _ => return None,
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
        assert_eq!(checksum(b"123456789"), 0x906e);
    }

    fn frame(status: u16, microseconds: u32) -> [u8; LENGTH] {
        let mut frame = [0; LENGTH];
        frame[0] = 0xaa;
        frame[1..3].copy_from_slice(&status.to_le_bytes());
        frame[27..31].copy_from_slice(&microseconds.to_le_bytes());
        let check = checksum(&frame[1..35]);
        frame[35..].copy_from_slice(&check.to_le_bytes());
        frame
    }

    #[test]
    fn status_and_time() {
        let mut protocol = Framed::new(Bota::default());
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

    #[test]
    fn set_up() {
        let mut protocol = Framed::new(Bota { filter: Some(BotaFilter { sinc: 512, ..BotaFilter::default() }) });
        assert_eq!(*protocol.request(0.0).unwrap(), *b"C");
        assert_eq!(protocol.decode(&mut &b"App Init\r\nr,0,C,0\r\n"[..], 0.0), None);
        assert_eq!(*protocol.request(0.1).unwrap(), *b"f,512,0,0,1");
        let refused = protocol.decode(&mut &b"r,0,f,1"[..], 0.1);
        assert_eq!(refused, Some(Err(FrameFault::Refused { request: b'f', code: b'1' })));
        assert_eq!(protocol.decode(&mut &b"r,0,f,0"[..], 0.1), None);
        assert_eq!(*protocol.request(0.2).unwrap(), *b"R");
        assert_eq!(protocol.counters().answers, 3);
        assert_eq!(protocol.counters().skipped_bytes, 12);
    }
}
