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
use crate::sample::Quality;

const SYNC: u8 = 0xaa;
const TERMINATOR: u8 = 0x85;

/// Commands.
const STOP: u8 = 0x23;
const START: u8 = 0x24;
const SET_TX_MODE: u8 = 0x81;

/// Frames of a GSV-8 or GSV-6, which is asked for values as f32 and started. Rate, zero and unit stay as the device is set.
///
/// Channels are in the unit that the device is set to. There is no checksum: what a flipped bit changes within a value is not
/// detected, and one in the number of channels may make one frame of two. A device that sends integers is a fault.
///
/// ```
/// use rod_hw::device::framed::{Framed, Gsv};
/// use rod_hw::{Protocol, Quality};
/// let mut protocol = Framed::new(Gsv);
/// assert_eq!(*protocol.request(0.0).ok_or("none")?, [0xaa, 0x90, 0x23, 0x85]); // stop, first of all
/// let frame = [0xaa, 0x11, 0xb1, 0x3d, 0xcc, 0xcc, 0xcd, 0xbe, 0x4c, 0xcc, 0xcd, 0x85];
/// let sample = protocol.decode(&mut &frame[..], 0.0).ok_or("no sample")??;
/// assert_eq!(sample.channels[..], [0.1_f32, -0.2].map(f64::from));
/// assert_eq!((sample.status, sample.quality), (0xb1, Quality::SATURATED));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gsv;

impl Framing for Gsv {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [SYNC] => Head::Open,
            [SYNC, kind] if matches!(kind >> 4, 1 | 5) => Head::Open,
            // the code of the type is one less than the bytes of a value
            [SYNC, kind, status, ..] => match (kind >> 4, status >> 4) {
                (1, code @ 9..=11) => Head::Length(4 + usize::from(kind % 16 + 1) * usize::from(code - 7)),
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
        // values as f32
        if frame[1] >> 4 == 1 { differs(2, 0xb0 | frame[2] & 0x0f) } else { Ok(()) }
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
        let values = payload.as_chunks().0.iter().map(|four| f32::from_be_bytes(*four).into());
        Content::Sample(Reading { status: status.into(), quality, ..Reading::new(super::channels(values)) })
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        let (command, request) = match step {
            0 => (STOP, stop()),
            // as the maker's library asks for f32 (the comment there says 03 for the 01 it sends)
            1 => (SET_TX_MODE, [SYNC, 0x93, SET_TX_MODE, 1, 0, 0x10, TERMINATOR].into()),
            2 => (START, [SYNC, 0x90, START, TERMINATOR].into()),
            _ => return None,
        };
        Some(SetupStep { request, command, until: Await::Answer })
    }

    fn farewell(&self) -> Option<Request> {
        Some(stop())
    }
}

fn stop() -> Request {
    [SYNC, 0x90, STOP, TERMINATOR].into()
}

/// The codes that answers begin with.
fn is_answer_code(code: u8) -> bool {
    matches!(code, 0 | 1 | 0x40..=0x42 | 0x50..=0x5f | 0x70..=0x75 | 0x80..=0x84 | 0x91 | 0x92 | 0x99)
}
