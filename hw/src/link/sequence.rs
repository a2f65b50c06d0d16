//! Sequence numbers: missing, repeated and late samples.

/// Follows the counter of a device, which wraps.
///
/// A number up to half the range ahead is an advance, one behind is late. A device that restarts counts from a low number
/// again, which looks late at first: two numbers in a row that are behind and follow each other are a restart.
///
/// ```
/// use rod_hw::{Sequence, SequenceStep};
/// let mut sequence = Sequence::new(32);
/// let steps: Vec<SequenceStep> = [u32::MAX - 1, u32::MAX, 0, 3, 3, 2, 4].map(|n| sequence.step(n)).into();
/// use SequenceStep::*;
/// assert_eq!(steps, [First, Next, Next, Gap(2), Repeated, Late, Next]);
/// assert_eq!(sequence.unwrapped(), u64::from(u32::MAX) + 5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sequence {
    bits: u32,
    last: Option<u32>,
    unwrapped: u64,
    /// The number that a restart would go on with.
    candidate: Option<u32>,
}

/// The meaning of a number after the ones before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SequenceStep {
    /// The first one.
    First,
    /// The one that was due.
    Next,
    /// So many are missing before it.
    Gap(u32),
    /// The one before once more.
    Repeated,
    /// One that should have come before, or the first of a device that restarted.
    Late,
    /// The second of a device that restarted.
    Restarted,
}

impl Sequence {
    /// A counter of so many bits (1 to 32) that grows by 1 from sample to sample.
    pub fn new(bits: u32) -> Self {
        Self { bits: bits.clamp(1, 32), last: None, unwrapped: 0, candidate: None }
    }

    /// Takes the number of a sample.
    pub fn step(&mut self, number: u32) -> SequenceStep {
        let Some(last) = self.last else {
            self.last = Some(number);
            self.unwrapped = u64::from(number);
            return SequenceStep::First;
        };
        let mask = u32::MAX >> (32 - self.bits);
        let ahead = number.wrapping_sub(last) & mask;
        let candidate = self.candidate.take();
        if ahead == 0 {
            SequenceStep::Repeated
        } else if ahead <= mask / 2 {
            self.last = Some(number);
            self.unwrapped += u64::from(ahead);
            if ahead == 1 { SequenceStep::Next } else { SequenceStep::Gap(ahead - 1) }
        } else if candidate == Some(number) {
            self.last = Some(number);
            // goes on growing
            self.unwrapped += 1;
            SequenceStep::Restarted
        } else {
            self.candidate = Some(number.wrapping_add(1) & mask);
            SequenceStep::Late
        }
    }

    /// How far ahead of the last number this one is, behind where negative; none before the first. For those who know more
    /// than one counter and decide themselves, with [`advance`](Self::advance).
    pub fn ahead(&self, number: u32) -> Option<i64> {
        let mask = u32::MAX >> (32 - self.bits);
        let ahead = number.wrapping_sub(self.last?) & mask;
        Some(if ahead <= mask / 2 { i64::from(ahead) } else { i64::from(ahead) - i64::from(mask) - 1 })
    }

    /// Goes on from this number: of the same run where it is ahead, of a new one otherwise. What
    /// [`unwrapped`](Self::unwrapped) tells grows in any case.
    ///
    /// ```
    /// use rod_hw::Sequence;
    /// let mut sequence = Sequence::new(32);
    /// sequence.advance(1000);
    /// assert_eq!(sequence.ahead(997), Some(-3));
    /// sequence.advance(1); // the device started anew
    /// assert_eq!((sequence.ahead(3), sequence.unwrapped()), (Some(2), 1001));
    /// ```
    pub fn advance(&mut self, number: u32) {
        self.unwrapped = match self.ahead(number) {
            None => u64::from(number),
            Some(ahead) => self.unwrapped + u64::try_from(ahead).unwrap_or(0).max(1),
        };
        self.last = Some(number);
        self.candidate = None;
    }

    /// The last number that was no repetition and not late, with the wraps counted.
    pub fn unwrapped(&self) -> u64 {
        self.unwrapped
    }
}
