//! What the sensor reads without load, taken off.

mod batches;
mod error;
mod limits;
mod window;
mod zero;

pub use error::TareError;
pub use limits::TareLimits;
pub use window::TareWindow;
pub use zero::Zero;

use crate::quality::Quality;
use crate::wrench::Wrench;
use crate::wrench_sample::WrenchSample;
use rod_core::Scalar;

/// The error of a zero is that of all samples it is taken off of: averaging them does not make it smaller. So many of its
/// standard deviations are its bound.
const BOUND: f64 = 3.0;

/// One or two zeros, to take off all samples.
///
/// ```
/// use rod_hw::{Quality, Tare, Wrench, WrenchSample, Zero};
/// let wrench = |force| Wrench { force: [force, 0.0, 0.0], torque: [0.0; 3] };
/// let zero = |force, from, to| Zero::known(wrench(force), wrench(1e-3), from, to);
/// // before first contact and after the last: the zero drifts by 40 mN in 100 s
/// let mut tare: Tare = Tare::two_point(zero(0.10, 0.0, 2.0)?, zero(0.14, 100.0, 102.0)?)?;
/// let sample = tare.apply(&WrenchSample::new(51.0, wrench(0.5)));
/// assert!((sample.wrench.force[0] - 0.38).abs() < 1e-15 && sample.quality.is_empty());
/// assert_eq!(tare.apply(&WrenchSample::new(200.0, wrench(0.5))).quality, Quality::TARE_STALE);
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tare<T = f64> {
    first: Zero<T>,
    last: Option<Zero<T>>,
    stale: bool,
}

impl<T: Scalar> Tare<T> {
    /// One zero for all samples.
    pub fn single(zero: Zero<T>) -> Self {
        Self { first: zero, last: None, stale: false }
    }

    /// Two zeros, and what is linear in time in between, from the middle of the first window to the middle of the second.
    /// It does not extrapolate: in the outer halves of the windows the nearer zero holds, and outside of both it holds,
    /// too, but samples are flagged [`Quality::TARE_STALE`].
    ///
    /// # Errors
    /// [`TareError::Order`] where the second does not begin after the end of the first.
    pub fn two_point(first: Zero<T>, last: Zero<T>) -> Result<Self, TareError> {
        if last.from <= first.to {
            return Err(TareError::Order { to: first.to, from: last.from });
        }
        Ok(Self { first, last: Some(last), stale: false })
    }

    /// The sample without the zero, in the order of time. Where bounds of systematic errors are known, three standard
    /// deviations of the zero are added to them; where they are not, they stay so.
    ///
    /// A sample that is the first one after the device or the connection started anew, and came later than the first one
    /// of the zero, makes the tare stale: it and all after it are flagged [`Quality::TARE_STALE`], until there is a new
    /// tare.
    pub fn apply(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        if sample.quality.contains(Quality::RESTARTED) && sample.raw.host_time > self.first.arrived {
            self.stale = true;
        }
        let (zero, sigma, covered) = self.at(sample.t);
        let mut tared = WrenchSample { wrench: sample.wrench - zero, ..*sample };
        tared.systematic = sample.systematic.map(|bound| bound + sigma * T::from_f64(BOUND));
        if self.stale || !covered {
            tared.quality |= Quality::TARE_STALE;
        }
        tared
    }

    /// The zero at a time (s), N and N m.
    pub fn zero_at(&self, t: f64) -> Wrench<T> {
        self.at(t).0
    }

    /// Zero and its standard deviation at a time, and whether that is within what is known.
    fn at(&self, t: f64) -> (Wrench<T>, Wrench<T>, bool) {
        let first = &self.first;
        let Some(last) = &self.last else { return (first.wrench, first.sigma, true) };
        let share = (t - first.middle()) / (last.middle() - first.middle());
        // not clamp: a time that is no number gets a zero that is one, and the flag
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let [a, b] = [1.0 - share, share].map(T::from_f64);
        let zero = first.wrench * a + last.wrench * b;
        let sigma = first.sigma.zip(&last.sigma, |s, r| (a * s * (a * s) + b * r * (b * r)).sqrt());
        (zero, sigma, (first.from..=last.to).contains(&t))
    }

    /// Makes it stale: the sensor was moved, or its own bias set. All samples from here on are flagged.
    pub fn invalidate(&mut self) {
        self.stale = true;
    }

    /// Whether it is stale.
    pub fn is_stale(&self) -> bool {
        self.stale
    }
}

#[cfg(test)]
mod tests;
