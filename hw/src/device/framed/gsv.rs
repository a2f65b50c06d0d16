//! ME-Messsysteme GSV-8 and GSV-6.
//!
//! Frames, big-endian, without a checksum:
//!
//! ```text
//! request  AA  90 + length        command  payload         85
//! answer   AA  50 + length        error    payload         85
//! measure  AA  10 + channels - 1  status   channels values 85
//! status   bit 7 = 1, bits 6:4 type of values (1 i16, 2 i24, 3 f32), bit 1 six-axis error, bit 0 input overload
//! ```
//!
//! By default they send at 115,200 baud (GSV-8) and 230,400 baud (GSV-6), 8 bits, no parity, 1 stop bit.

use super::profile::{Await, Content, Framing, Head, Profile, Reading, SetupStep};
use crate::link::{FrameFault, Request};
use crate::sample::{Channels, Quality, Unit};

const SYNC: u8 = 0xaa;
const TERMINATOR: u8 = 0x85;

/// Commands.
pub(crate) mod command {
    pub(crate) const SET_ZERO: u8 = 0x0c;
    pub(crate) const STOP: u8 = 0x23;
    pub(crate) const START: u8 = 0x24;
    pub(crate) const GET_VALUE: u8 = 0x3b;
    pub(crate) const SET_TX_MODE: u8 = 0x81;
    pub(crate) const WRITE_RATE: u8 = 0x8b;
}

/// Counts per input range of values of 16 bits, which reach to 1.05 of it.
pub const COUNTS_16: f64 = 32_768.0 / 1.05;

/// Counts per input range of values of 24 bits, which reach to 1.05 of it.
pub const COUNTS_24: f64 = 8_388_608.0 / 1.05;

/// Frames of a GSV-8 or GSV-6. [`Default`]: values as f32, of any number of channels, nothing changed but that and started.
///
/// Channels are in the unit that the device is set to (f32; [`unit()`]), or counts about zero ([`COUNTS_16`], [`COUNTS_24`]).
/// There is no checksum: what a flipped bit changes within a value is not detected, and one in the number of channels may
/// make one frame of two unless `channels` says how many there are. A device in another mode of values, or with other
/// channels than said here, is not read but a fault.
///
/// ```
/// use rod_hw::device::framed::{Framed, Gsv};
/// use rod_hw::{Protocol, Quality};
/// let mut protocol = Framed::new(Gsv { rate: Some(500.0), ..Gsv::default() });
/// assert_eq!(*protocol.request(0.0).ok_or("none")?, [0xaa, 0x90, 0x23, 0x85]); // stop, first of all
/// let frame = [0xaa, 0x11, 0xb1, 0x3d, 0xcc, 0xcc, 0xcd, 0xbe, 0x4c, 0xcc, 0xcd, 0x85];
/// let sample = protocol.decode(&mut &frame[..], 0.0).ok_or("no sample")??;
/// assert_eq!(sample.channels[..], [0.1_f32, -0.2].map(f64::from));
/// assert_eq!((sample.status, sample.quality), (0xb1, Quality::SATURATED));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gsv {
    /// The type of the values. f32 is asked for, the others must be set at the device.
    pub values: GsvValues,
    /// How many channels there are, where they must be so many.
    pub channels: Option<usize>,
    /// Rate to set, Hz; what the device is set to, where none.
    pub rate: Option<f32>,
    /// Whether what its channels (6 where `channels` is none) measure at the start is zero.
    pub zero: bool,
}

/// Types of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GsvValues {
    /// Counts of 16 bits.
    I16,
    /// Counts of 24 bits.
    I24,
    /// Values in the unit of the device.
    F32,
}

impl GsvValues {
    /// Code in the status, which is also one less than the bytes of a value.
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::I16 => 1,
            Self::I24 => 2,
            Self::F32 => 3,
        }
    }

    fn of(status: u8) -> Option<Self> {
        [Self::I16, Self::I24, Self::F32].into_iter().find(|values| status >> 4 == 8 | values.code())
    }
}

impl Default for Gsv {
    fn default() -> Self {
        Self { values: GsvValues::F32, channels: None, rate: None, zero: false }
    }
}

impl Framing for Gsv {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [SYNC] => Head::Open,
            [SYNC, kind] if matches!(kind >> 4, 1 | 5) => Head::Open,
            [SYNC, kind, status, ..] => match (kind >> 4, GsvValues::of(status)) {
                (1, Some(values)) => Head::Length(4 + usize::from(kind % 16 + 1) * usize::from(values.code() + 1)),
                (5, _) if is_answer_code(status) => Head::Length(4 + usize::from(kind % 16)),
                _ => Head::Other,
            },
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let differs = |at: usize, expected: u8| {
            let found = frame.get(at).copied().unwrap_or_default();
            if found == expected { Ok(()) } else { Err(FrameFault::Marker { at, found, expected }) }
        };
        differs(frame.len() - 1, TERMINATOR)?;
        if frame[1] >> 4 == 1 {
            if let Some(channels) = self.channels.and_then(|channels| u8::try_from(channels).ok()) {
                differs(1, 0x0f_u8.wrapping_add(channels))?;
            }
            differs(2, 0x80 | self.values.code() << 4 | frame[2] & 0x0f)?;
        }
        Ok(())
    }
}

impl Profile for Gsv {
    fn content(&self, frame: &[u8]) -> Content {
        let (kind, status, payload) = (frame[1], frame[2], &frame[3..frame.len() - 1]);
        if kind >> 4 == 5 {
            return if status <= 1 { Content::Answer } else { Content::Refusal(status) };
        }
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & 1 != 0);
        quality.set(Quality::DEVICE_ERROR, status & 2 != 0);
        let channels = match self.values {
            GsvValues::F32 => super::channels(super::doubles(payload).map(|four| f32::from_be_bytes(four).into())),
            GsvValues::I16 => {
                let rails = super::words(payload).any(|word| matches!(word, [0, 0] | [0xff, 0xff]));
                quality.set(Quality::SATURATED, status & 1 != 0 || rails);
                super::channels(super::words(payload).map(|word| f64::from(u16::from_be_bytes(word)) - 32_768.0))
            }
            GsvValues::I24 => {
                let counts = || payload.chunks_exact(3).map(|b| u32::from_be_bytes([0, b[0], b[1], b[2]]));
                let rails = counts().any(|count| matches!(count, 0 | 0x00ff_ffff));
                quality.set(Quality::SATURATED, status & 1 != 0 || rails);
                super::channels(counts().map(|count| f64::from(count) - 8_388_608.0))
            }
        };
        Content::Sample(Reading { status: status.into(), quality, ..Reading::new(channels) })
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        let answered = |command, request| SetupStep { request, command, until: Await::Answer };
        let zeroed = if self.zero { self.channels.unwrap_or(6).min(Channels::MOST) as u8 } else { 0 };
        let steps = [
            Some(answered(command::STOP, stop())),
            (self.values == GsvValues::F32).then(|| answered(command::SET_TX_MODE, send_floats())),
            self.rate.map(|rate| answered(command::WRITE_RATE, set_rate(rate))),
        ];
        let zeros = (1..=zeroed).map(|channel| answered(command::SET_ZERO, set_zero(channel)));
        steps.into_iter().flatten().chain(zeros).chain([answered(command::START, start())]).nth(step)
    }

    fn farewell(&self) -> Option<Request> {
        Some(stop())
    }
}

/// The codes that answers begin with.
fn is_answer_code(code: u8) -> bool {
    matches!(code, 0 | 1 | 0x40..=0x42 | 0x50..=0x5f | 0x70..=0x75 | 0x80..=0x84 | 0x91 | 0x92 | 0x99)
}

/// Request: start sending. What is asked of a device while it measures is for [`Transport::send`](crate::Transport::send).
pub fn start() -> Request {
    [SYNC, 0x90, command::START, TERMINATOR].into()
}

/// Request: stop sending.
pub fn stop() -> Request {
    [SYNC, 0x90, command::STOP, TERMINATOR].into()
}

/// Request: one frame of what is measured now, of a device that is stopped. It is answered by that frame.
pub fn get_value() -> Request {
    [SYNC, 0x90, command::GET_VALUE, TERMINATOR].into()
}

/// Request: send the values as f32, as the maker's library asks for it (the comment there says 03 for the 01 it sends).
pub fn send_floats() -> Request {
    [SYNC, 0x93, command::SET_TX_MODE, 1, 0, 0x10, TERMINATOR].into()
}

/// Request: this rate, Hz.
pub fn set_rate(rate: f32) -> Request {
    let [a, b, c, d] = rate.to_be_bytes();
    [SYNC, 0x94, command::WRITE_RATE, a, b, c, d, TERMINATOR].into()
}

/// Request: what this channel, from 1, measures now is zero.
pub fn set_zero(channel: u8) -> Request {
    [SYNC, 0x91, command::SET_ZERO, channel, TERMINATOR].into()
}

/// The unit of a code that the device tells; none for codes of what is no force, torque, length, angle, or temperature in
/// degrees Celsius.
///
/// ```
/// use rod_hw::device::framed::gsv;
/// assert_eq!(gsv::unit(17).map(|unit| (unit.name, unit.factor)), Some(("cN m", 1e-2)));
/// assert_eq!(gsv::unit(0), None); // mV/V
/// ```
pub fn unit(code: u8) -> Option<Unit> {
    let name = match code {
        1 | 12 => "kgf",
        2 => "gf",
        3 => "N",
        4 => "cN",
        9 => "kN",
        10 | 13 => "lbf",
        15 => "mm",
        16 => "m",
        17 => "cN m",
        18 => "N m",
        19 => "degC",
        24 => "kN m",
        35 => "deg",
        _ => return None,
    };
    Unit::find(name)
}
