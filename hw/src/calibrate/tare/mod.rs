//! The tare: the reading without load, subtracted.

mod batches;
mod error;
mod window;
mod zero;

pub use error::TareError;
pub use window::{TareLimits, TareWindow};
pub use zero::Zero;

use crate::sample::{Number, Quality, WrenchSample};

/// Bound of the error of a zero, in its standard deviations. The error is the same for all samples, so averaging does not reduce
/// it.
const BOUND: f64 = 3.0;

/// A zero, to take off all samples.
///
/// ```
/// use rod_hw::{Quality, Tare, Wrench, WrenchSample, Zero};
/// let wrench = |force| Wrench { force: [force, 0.0, 0.0], torque: [0.0; 3] };
/// let mut tare: Tare = Tare::single(Zero::known(wrench(0.125), wrench(1e-3), 2.0)?);
/// let mut sample = WrenchSample::new(51.0, wrench(0.5));
/// assert_eq!(tare.apply(&sample).wrench.force[0], 0.375);
/// // the device started anew, after the zero was measured
/// (sample.quality, sample.raw.host_time) = (Quality::RESTARTED, 52.0);
/// assert_eq!(tare.apply(&sample).quality, Quality::RESTARTED | Quality::TARE_STALE);
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tare<T = f64> {
    zero: Zero<T>,
    stale: bool,
}

impl<T: Number> Tare<T> {
    /// One zero for all samples.
    pub fn single(zero: Zero<T>) -> Self {
        Self { zero, stale: false }
    }

    /// The sample without the zero, in the order of time. Where bounds of systematic errors are known, three standard
    /// deviations of the zero are added to them; where they are not, they stay so.
    ///
    /// A sample that is the first one after the device or the connection restarted, and came later than the first one
    /// of the zero, makes the tare stale: it and all after it are flagged [`Quality::TARE_STALE`], until there is a new
    /// tare.
    pub fn apply(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        if sample.quality.contains(Quality::RESTARTED) && sample.raw.host_time > self.zero.arrived {
            self.stale = true;
        }
        let mut tared = WrenchSample { wrench: sample.wrench - self.zero.wrench, ..*sample };
        tared.systematic = sample.systematic.map(|bound| bound + self.zero.sigma * T::from_f64(BOUND));
        if self.stale {
            tared.quality |= Quality::TARE_STALE;
        }
        tared
    }
}
