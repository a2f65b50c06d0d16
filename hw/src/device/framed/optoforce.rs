//! OptoForce and OnRobot sensors with the USB converter.

use super::profile::{Await, Content, Counter, Framing, Head, Profile, Reading, SetupStep};
use super::word_at;
use crate::device::onrobot_filter::OnRobotFilter;
use crate::link::{FrameFault, Request};
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
/// By [`Default`] it listens to what the sensor sends by itself.
///
/// ```
/// use rod_hw::Protocol;
/// use rod_hw::device::framed::{Framed, OptoForce, OptoForceFilter, OptoForceRate, OptoForceSetup};
/// let setup = OptoForceSetup { rate: OptoForceRate::Hz1000, filter: OptoForceFilter::None, zero: true };
/// let mut protocol = Framed::new(OptoForce { setup: Some(setup), ..OptoForce::default() });
/// assert_eq!(*protocol.request(0.0).ok_or("none")?, [0xaa, 0, 0x32, 3, 1, 0, 255, 1, 0xdf]);
/// let bytes = [0xaa, 0, 0x50, 1, 0, 0, 0xfb, 0xaa, 7, 8, 10, 0, 1, 0, 0, 0, 100, 0xff, 0xfe, 0, 0, 3, 0x25];
/// let sample = protocol.decode(&mut &bytes[..], 0.0).ok_or("no sample")??;
/// assert_eq!((sample.sequence, sample.device_time), (Some(1), Some(1e-3)));
/// assert_eq!(sample.channels[..], [100.0, -2.0, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OptoForce {
    /// What to set up, if anything.
    pub setup: Option<OptoForceSetup>,
    /// By how much the count grows from frame to frame: 1 where it counts frames, 10 where it counts ms at 100 Hz.
    pub stride: u16,
}

impl Default for OptoForce {
    fn default() -> Self {
        Self { setup: None, stride: 1 }
    }
}

/// What can be set at an OptoForce sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OptoForceSetup {
    /// Frames a second.
    pub rate: OptoForceRate,
    /// Low-pass filter.
    pub filter: OnRobotFilter,
    /// Whether what is measured now is zero.
    pub zero: bool,
}

/// Rates of an OptoForce sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptoForceRate {
    /// 1000 frames a second.
    Hz1000,
    /// 333 frames a second.
    Hz333,
    /// 100 frames a second.
    Hz100,
    /// 30 frames a second.
    Hz30,
    /// 10 frames a second.
    Hz10,
}

impl OptoForceRate {
    /// Time from frame to frame, ms, which is also its code.
    pub fn milliseconds(self) -> u8 {
        match self {
            Self::Hz1000 => 1,
            Self::Hz333 => 3,
            Self::Hz100 => 10,
            Self::Hz30 => 33,
            Self::Hz10 => 100,
        }
    }
}

/// The sum of bytes.
pub(crate) fn sum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_add((*byte).into()))
}

impl Framing for OptoForce {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [0xaa] | [0xaa, 0 | 7] | [0xaa, 0, 0x50] | [0xaa, 7, 8] => Head::Open,
            // 2 more for the sum
            [0xaa, 7, 8, length @ (10 | 16 | 28), ..] => Head::Length(usize::from(length) + 6),
            [0xaa, 0, 0x50, 1, ..] => Head::Length(7),
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let end = frame.len() - 2;
        let (found, expected) = (u16::from_be_bytes(word_at(frame, end)), sum(&frame[..end]));
        if found == expected { Ok(()) } else { Err(FrameFault::Checksum { found, expected }) }
    }
}

impl Profile for OptoForce {
    fn content(&self, frame: &[u8]) -> Content {
        if frame[1] == 0 {
            return if frame[4] == 0 { Content::Answer } else { Content::Refusal(frame[4]) };
        }
        let status = u16::from_be_bytes(word_at(frame, 6));
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & 0x03f0 != 0);
        quality.set(Quality::DEVICE_ERROR, status & 0xfc00 != 0);
        quality.set(Quality::DEVICE_WARNING, status & 0x000f != 0 && status & 0xfff0 == 0);
        let counts = super::words(&frame[8..frame.len() - 2]).map(|word| i16::from_be_bytes(word).into());
        Content::Sample(Reading {
            status: status.into(),
            quality,
            number: Some(u16::from_be_bytes(word_at(frame, 4)).into()),
            ..Reading::new(super::channels(counts))
        })
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        let OptoForceSetup { rate, filter, zero } = self.setup.filter(|_| step == 0)?;
        Some(SetupStep {
            request: configure(rate.milliseconds(), filter as u8, if zero { 255 } else { 0 }),
            command: 0x32,
            until: Await::Answer,
        })
    }

    fn counter(&self) -> Option<Counter> {
        let stride = u32::from(self.stride.max(1));
        let period = self.setup.map(|setup| 1e-3 * f64::from(setup.rate.milliseconds()));
        Some(Counter { bits: 16, stride, tick: period.map(|period| period / f64::from(stride)) })
    }

    fn farewell(&self) -> Option<Request> {
        // what was not started is not stopped
        self.setup.map(|setup| configure(0, setup.filter as u8, 0))
    }
}

fn configure(speed: u8, filter: u8, zero: u8) -> Request {
    let bytes = [0xaa, 0, 0x32, 3, speed, filter, zero];
    let [high, low] = sum(&bytes).to_be_bytes();
    let [a, b, c, d, e, f, g] = bytes;
    [a, b, c, d, e, f, g, high, low].into()
}
