//! A GSV-8 that is a program.

use super::FakeDevice;
use rod_hw::device::framed::{Framing, Head, Scanner};
use rod_hw::{FrameFault, Quality};

/// Codes of its answers.
const OK: u8 = 0x00;
const UNKNOWN_COMMAND: u8 = 0x40;
const BAD_PARAMETER: u8 = 0x50;
const BAD_ADDRESS: u8 = 0x51;
const TOO_BIG: u8 = 0x54;
const TOO_SMALL: u8 = 0x55;
const WRONG_COUNT: u8 = 0x5b;

/// Commands that it hears.
mod command {
    pub(super) const SET_ZERO: u8 = 0x0c;
    pub(super) const STOP: u8 = 0x23;
    pub(super) const START: u8 = 0x24;
    pub(super) const GET_VALUE: u8 = 0x3b;
    pub(super) const SET_TX_MODE: u8 = 0x81;
    pub(super) const READ_RATE: u8 = 0x8a;
    pub(super) const WRITE_RATE: u8 = 0x8b;
}

/// The most that the maker speaks of, Hz.
const FASTEST: f32 = 12_000.0;

/// A GSV-8 (or GSV-6) that waits to be started: start, stop, one value, rate (read and set), values as f32, zero. Values are
/// in its unit.
///
/// ```
/// use rod_hw::Quality;
/// use rod_fake_sensor::{FakeDevice, FakeGsv8};
/// let (mut device, mut bytes) = (FakeGsv8::new(6, 100.0), Vec::new());
/// device.hear(&[0xaa, 0x90, 0x24, 0x85], &mut bytes); // start
/// assert!(device.is_sending() && bytes == [0xaa, 0x50, 0, 0x85]);
/// bytes.clear();
/// device.measure(&[0.1, -0.2, 0.3, 0.0, 0.0, 0.0125], Quality::empty(), &mut bytes);
/// assert_eq!(bytes[..7], [0xaa, 0x15, 0xb0, 0x3d, 0xcc, 0xcc, 0xcd]);
/// ```
#[derive(Clone, Debug)]
pub struct FakeGsv8 {
    rate: f32,
    sending: bool,
    single: bool,
    scanner: Scanner,
    last: Vec<f64>,
    zero: Vec<f64>,
}

impl FakeGsv8 {
    /// A device of so many channels (1 to 16), at a rate (Hz).
    pub fn new(channels: usize, rate: f64) -> Self {
        let zero = vec![0.0; channels.clamp(1, 16)];
        let (rate, last) = (rate as f32, zero.clone());
        Self { rate, sending: false, single: false, scanner: Scanner::default(), last, zero }
    }

    /// Executes a request and returns the answer, if there is one.
    fn obey(&mut self, command: u8, payload: &[u8]) -> Option<(u8, Vec<u8>)> {
        let code = match (command, payload) {
            (command::START, []) => {
                self.sending = true;
                OK
            }
            (command::STOP, []) => {
                self.sending = false;
                OK
            }
            (command::GET_VALUE, []) => {
                self.single = true;
                return None;
            }
            (command::READ_RATE, []) => return Some((OK, self.rate.to_be_bytes().to_vec())),
            (command::WRITE_RATE, &[a, b, c, d]) => match f32::from_be_bytes([a, b, c, d]) {
                rate if rate > FASTEST => TOO_BIG,
                rate if rate > 0.0 => {
                    self.rate = rate;
                    OK
                }
                _ => TOO_SMALL,
            },
            (command::SET_ZERO, &[channel]) => {
                let i = usize::from(channel).wrapping_sub(1);
                match (self.zero.get_mut(i), self.last.get(i)) {
                    (Some(zero), Some(last)) => {
                        *zero = *last;
                        OK
                    }
                    _ => BAD_ADDRESS,
                }
            }
            (command::SET_TX_MODE, [_, 0x00, 0x10]) => OK,
            (command::SET_TX_MODE, [_, _, _]) => BAD_PARAMETER,
            (
                command::START
                | command::STOP
                | command::GET_VALUE
                | command::READ_RATE
                | command::WRITE_RATE
                | command::SET_ZERO
                | command::SET_TX_MODE,
                _,
            ) => WRONG_COUNT,
            _ => UNKNOWN_COMMAND,
        };
        Some((code, Vec::new()))
    }
}

impl FakeDevice for FakeGsv8 {
    fn hear(&mut self, mut bytes: &[u8], answers: &mut Vec<u8>) {
        while let Some(request) = self.scanner.next(&mut bytes, &Requests) {
            let Ok([_, _, command, payload @ .., _]) = request else { continue };
            let (command, payload) = (*command, payload.to_vec());
            if let Some((code, payload)) = self.obey(command, &payload) {
                answers.extend([0xaa, 0x50 | payload.len() as u8, code]);
                answers.extend(payload);
                answers.push(0x85);
            }
        }
    }

    fn measure(&mut self, values: &[f64], quality: Quality, frame: &mut Vec<u8>) {
        let mut status = 0xb0;
        if quality.contains(Quality::SATURATED) {
            status |= 1;
        }
        if quality.contains(Quality::DEVICE_ERROR) {
            status |= 2;
        }
        frame.extend([0xaa, 0x10 | (self.zero.len() - 1) as u8, status]);
        for (i, (last, zero)) in self.last.iter_mut().zip(&self.zero).enumerate() {
            *last = values.get(i).copied().unwrap_or_default();
            frame.extend(((*last - zero) as f32).to_be_bytes());
        }
        frame.push(0x85);
    }

    fn restart(&mut self) {
        (self.sending, self.single, self.scanner) = (false, false, Scanner::default());
    }

    fn is_sending(&self) -> bool {
        self.sending
    }

    fn rate(&self) -> f64 {
        self.rate.into()
    }

    fn take_single(&mut self) -> bool {
        std::mem::take(&mut self.single)
    }
}

/// The requests of the host.
struct Requests;

impl Framing for Requests {
    fn head(&self, bytes: &[u8]) -> Head {
        match *bytes {
            [0xaa] => Head::Open,
            [0xaa, kind, ..] if kind >> 4 == 9 => Head::Length(4 + usize::from(kind % 16)),
            _ => Head::Other,
        }
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let (at, found) = (frame.len() - 1, frame.last().copied().unwrap_or_default());
        if found == 0x85 { Ok(()) } else { Err(FrameFault::Marker { at, found, expected: 0x85 }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(rate: f32) -> Vec<u8> {
        [&[0xaa, 0x94, 0x8b][..], &rate.to_be_bytes(), &[0x85]].concat()
    }

    fn answer(device: &mut FakeGsv8, request: &[u8]) -> Vec<u8> {
        let mut answers = Vec::new();
        // as it may come: byte by byte, after noise
        [&[0x85, 0xaa, 0x00], request].concat().iter().for_each(|byte| device.hear(&[*byte], &mut answers));
        answers
    }

    #[test]
    fn answers() {
        let mut device = FakeGsv8::new(2, 100.0);
        let told = |code| vec![0xaa, 0x50, code, 0x85];
        assert_eq!(answer(&mut device, &rate(250.0)), told(OK));
        assert_eq!(answer(&mut device, &[0xaa, 0x90, 0x8a, 0x85]), [0xaa, 0x54, 0, 0x43, 0x7a, 0, 0, 0x85]);
        assert_eq!(answer(&mut device, &rate(1e6)), told(TOO_BIG));
        assert_eq!(answer(&mut device, &rate(f32::NAN)), told(TOO_SMALL));
        assert_eq!(answer(&mut device, &[0xaa, 0x91, 0x0c, 3, 0x85]), told(BAD_ADDRESS));
        assert_eq!(answer(&mut device, &[0xaa, 0x91, 0x24, 0, 0x85]), told(WRONG_COUNT));
        assert_eq!(answer(&mut device, &[0xaa, 0x90, 0x77, 0x85]), told(UNKNOWN_COMMAND));
        assert_eq!(answer(&mut device, &[0xaa, 0x90, 0x3b, 0x85]), []);
        assert!(device.take_single() && !device.take_single() && !device.is_sending());
    }

    #[test]
    fn values_and_zero() {
        let mut device = FakeGsv8::new(2, 100.0);
        let mut frame = Vec::new();
        device.measure(&[-3.0, 1.0], Quality::SATURATED, &mut frame);
        assert_eq!(frame, [0xaa, 0x11, 0xb1, 0xc0, 0x40, 0, 0, 0x3f, 0x80, 0, 0, 0x85]);
        assert_eq!(answer(&mut device, &[0xaa, 0x91, 0x0c, 1, 0x85]), [0xaa, 0x50, OK, 0x85]);
        assert_eq!(answer(&mut device, &[0xaa, 0x93, 0x81, 1, 0, 0x10, 0x85]), [0xaa, 0x50, OK, 0x85]);
        frame.clear();
        device.measure(&[-2.0], Quality::DEVICE_ERROR, &mut frame);
        assert_eq!(frame, [0xaa, 0x11, 0xb2, 0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0x85]);
    }
}
