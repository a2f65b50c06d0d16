//! Finds frames in a stream of bytes.

use super::profile::{Framing, Head};
use crate::link::FrameFault;

/// The most bytes that a frame may have.
pub const LONGEST_FRAME: usize = 128;

/// Cuts a stream of bytes into frames. After a damaged one it goes on at the byte after its first, so that a good frame
/// within is not lost. It keeps at most [`LONGEST_FRAME`] bytes.
///
/// Every byte is one of: of a good frame, skipped, still held.
///
/// ```
/// use rod_hw::device::framed::{Gsv, Scanner};
/// let answer = [0xaa, 0x50, 0x00, 0x85];
/// let stream = [&[7, 7, 7][..], &answer, &[7, 0xaa, 0x50]].concat();
/// let (mut scanner, mut bytes) = (Scanner::default(), &stream[..]);
/// assert_eq!(scanner.next(&mut bytes, &Gsv), Some(Ok(&answer[..])));
/// assert_eq!(scanner.next(&mut bytes, &Gsv), None);
/// assert_eq!((scanner.skipped(), scanner.held()), (4, 2));
/// ```
#[derive(Clone, Debug)]
pub struct Scanner {
    buffer: [u8; LONGEST_FRAME],
    from: usize,
    to: usize,
    /// The frame that was handed out last, to be forgotten.
    out: usize,
    /// The remaining length of the last damaged frame. A damaged frame that begins within it is most likely its payload.
    damaged: usize,
    skipped: u64,
}

impl Default for Scanner {
    fn default() -> Self {
        Self { buffer: [0; LONGEST_FRAME], from: 0, to: 0, out: 0, damaged: 0, skipped: 0 }
    }
}

impl Scanner {
    /// Consumes bytes from the front, up to the next frame or damaged frame; `None` if they do not suffice.
    ///
    /// A damaged frame is reported once: other damaged frames that begin within its length are taken for its payload.
    pub fn next(&mut self, bytes: &mut &[u8], framing: &impl Framing) -> Option<Result<&[u8], FrameFault>> {
        self.from += core::mem::take(&mut self.out);
        loop {
            let held = &self.buffer[self.from..self.to];
            let length = match if held.is_empty() { Head::Open } else { framing.head(held) } {
                Head::Open if held.len() < LONGEST_FRAME => held.len() + 1,
                Head::Length(length) if (1..=LONGEST_FRAME).contains(&length) => length,
                _ => {
                    self.skip();
                    continue;
                }
            };
            if held.len() < length {
                self.fill(bytes, length);
                if self.to - self.from < length {
                    return None;
                }
                continue;
            }
            match framing.check(&held[..length]) {
                Ok(()) => {
                    self.out = length;
                    self.damaged = 0;
                    return Some(Ok(&self.buffer[self.from..self.from + length]));
                }
                Err(fault) => {
                    let new = self.damaged == 0;
                    if new {
                        self.damaged = length;
                    }
                    self.skip();
                    if new {
                        return Some(Err(fault));
                    }
                }
            }
        }
    }

    /// Bytes that belong to no good frame, those of damaged ones included.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Bytes of a frame that is not whole yet.
    pub fn held(&self) -> usize {
        self.to - self.from - self.out
    }

    /// Forgets what is held, which counts as skipped.
    pub fn reset(&mut self) {
        *self = Self { skipped: self.skipped + self.held() as u64, ..Self::default() };
    }

    fn skip(&mut self) {
        self.from += 1;
        self.skipped += 1;
        self.damaged = self.damaged.saturating_sub(1);
    }

    /// Takes bytes until so many are held, as far as there are any.
    fn fill(&mut self, bytes: &mut &[u8], length: usize) {
        if self.from + length > LONGEST_FRAME {
            self.buffer.copy_within(self.from..self.to, 0);
            (self.from, self.to) = (0, self.to - self.from);
        }
        let (new, rest) = bytes.split_at(bytes.len().min(self.from + length - self.to));
        self.buffer[self.to..self.to + new.len()].copy_from_slice(new);
        self.to += new.len();
        *bytes = rest;
    }
}
