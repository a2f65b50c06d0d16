//! Where the samples of a live scan come from.

use crate::SensorCalibration;
use vibrissa::hw::{LinkCounters, RawSample, ReactionSample};

/// A sample as its source gives it.
#[derive(Clone, Copy, Debug)]
pub enum Fed {
    /// As the device sent it.
    Raw(RawSample),
    /// As reactions with poses, which recordings may contain.
    Reactions(ReactionSample),
}

/// Why there is no sample.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Miss {
    /// Nothing came in time; more may come.
    Silence(String),
    /// The device sent something else; more may come.
    Fault(String),
}

/// A source of samples: one per call, or the reason why there is none; `None` at the end.
pub trait Feed {
    /// The next sample, after about a second at most.
    fn next(&mut self) -> Option<Result<Fed, Miss>>;

    /// Counters of the connection so far.
    fn counters(&self) -> LinkCounters;

    /// Time, s, by the clock of the samples' host times; none for a recording.
    fn now(&self) -> Option<f64>;
}

/// A sensor that is connected.
pub struct Sensor {
    /// Its samples.
    pub feed: Box<dyn Feed>,
    /// Its calibration to N and N m; none where the samples are reactions already.
    pub calibration: Option<SensorCalibration>,
    /// Its name for the record.
    pub name: String,
    /// The time 0 of its samples, s since 1970; none where it is not known, or where they count from 1970 themselves.
    pub epoch: Option<f64>,
}
