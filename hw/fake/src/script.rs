//! A script of faults.

use rod_hw::Quality;

/// A fault of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// These bytes come before it.
    Before(Vec<u8>),
    /// These bytes come within it, before its byte `at`.
    Within {
        /// From 0.
        at: usize,
        /// The bytes sent in its place.
        bytes: Vec<u8>,
    },
    /// This bit is flipped: bit 0 is the lowest of byte 0.
    Flip(usize),
    /// Only this number of its bytes is sent.
    Cut(usize),
    /// It is measured and counted, but not sent.
    Lost,
    /// The device says this of it.
    Report(Quality),
    /// The device is unplugged before it, once.
    Disconnect,
}

/// The faults by number of the frame, from 0.
///
/// ```
/// use rod_fake_sensor::{Fault, Script};
/// let script = Script::new().at(3, Fault::Lost).every(100, Fault::Flip(70));
/// assert_eq!(script.faults(3).count(), 1);
/// assert_eq!(script.faults(300).count(), 1);
/// assert_eq!(script.faults(0).count(), 0);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Script {
    rules: Vec<(Rule, Fault)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    At(u64),
    Every(u64),
}

impl Script {
    /// Nothing goes wrong.
    pub fn new() -> Self {
        Self::default()
    }

    /// This goes wrong with this frame, too.
    #[must_use]
    pub fn at(mut self, frame: u64, fault: Fault) -> Self {
        self.rules.push((Rule::At(frame), fault));
        self
    }

    /// This goes wrong with every n-th frame, too, but for frame 0.
    #[must_use]
    pub fn every(mut self, n: u64, fault: Fault) -> Self {
        self.rules.push((Rule::Every(n.max(1)), fault));
        self
    }

    /// A fault of a frame.
    pub fn faults(&self, frame: u64) -> impl Iterator<Item = &Fault> {
        let applies = move |rule: &Rule| match *rule {
            Rule::At(at) => at == frame,
            Rule::Every(n) => frame > 0 && frame.is_multiple_of(n),
        };
        self.rules.iter().filter(move |(rule, _)| applies(rule)).map(|(_, fault)| fault)
    }

    /// The status of a frame.
    pub(super) fn quality(&self, frame: u64) -> Quality {
        self.faults(frame).fold(Quality::empty(), |quality, fault| match fault {
            Fault::Report(more) => quality | *more,
            _ => quality,
        })
    }

    /// The bytes sent in place of a frame; `None` if it is not sent.
    pub(super) fn damaged(&self, frame: u64, mut bytes: Vec<u8>) -> Option<Vec<u8>> {
        let mut before = Vec::new();
        for fault in self.faults(frame) {
            match fault {
                Fault::Before(garbage) => before.extend(garbage),
                Fault::Within { at, bytes: garbage } => {
                    let at = bytes.len().min(*at);
                    bytes.splice(at..at, garbage.iter().copied());
                }
                Fault::Flip(bit) => {
                    if let Some(byte) = bytes.get_mut(bit / 8) {
                        *byte ^= 1 << (bit % 8);
                    }
                }
                Fault::Cut(keep) => bytes.truncate(*keep),
                Fault::Lost => return None,
                Fault::Report(_) | Fault::Disconnect => {}
            }
        }
        before.extend(bytes);
        Some(before)
    }

    /// Whether the device is unplugged before a frame.
    pub(super) fn disconnects(&self, frame: u64) -> bool {
        self.faults(frame).any(|fault| *fault == Fault::Disconnect)
    }
}
