//! Where the samples of a live scan come from.

use vibrissa::hw::{LinkCounters, RawSample, ReactionSample};

/// A sample as its source has it.
#[derive(Clone, Copy, Debug)]
pub enum Fed {
    /// As the device sent it.
    Raw(RawSample),
    /// With everything done already, as recordings may have it.
    Reactions(ReactionSample),
}

/// Why there is no sample.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Miss {
    /// Nothing came in time; more may come.
    Silence(String),
    /// Something came that is no sample; more may come.
    Fault(String),
}

/// Where samples come from: one a call, no sample and why, or none where there are no more.
pub trait Feed {
    /// The next one; it comes back within a second or so.
    fn next(&mut self) -> Option<Result<Fed, Miss>>;

    /// What came over the connection so far.
    fn counters(&self) -> LinkCounters;

    /// Seconds by the clock that the samples' host times are of; none where they are played back.
    fn now(&self) -> Option<f64>;
}
