//! What a sensor reads without load.

use super::TareError;
use crate::sample::{Component, Number, Wrench};

/// What a sensor reads without load, and how well that is known.
///
/// ```
/// use rod_hw::{Wrench, Zero};
/// let wrench = Wrench { force: [0.1, 0.0, 0.0], torque: [0.0; 3] };
/// let zero = Zero::known(wrench, Wrench { force: [1e-3; 3], torque: [1e-5; 3] }, 0.0, 2.0)?;
/// assert_eq!((zero.wrench(), zero.middle()), (wrench, 1.0));
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero<T = f64> {
    pub(super) wrench: Wrench<T>,
    pub(super) sigma: Wrench<T>,
    pub(super) noise: Option<Wrench<T>>,
    pub(super) count: usize,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) arrived: f64,
}

impl<T: Number> Zero<T> {
    /// A zero known from elsewhere: its value and standard deviation (N and N m), from when to when it was measured (s), on
    /// the clock of the host and of the samples alike.
    ///
    /// # Errors
    /// [`TareError::Number`] where a number is not finite, a deviation negative, or the end before the beginning.
    pub fn known(wrench: Wrench<T>, sigma: Wrench<T>, from: f64, to: f64) -> Result<Self, TareError> {
        let check = |is_good: bool, field, value, expected| {
            if is_good { Ok(()) } else { Err(TareError::Number { field, value, expected }) }
        };
        for component in Component::ALL {
            let [value, deviation] = [wrench, sigma].map(|w| component.of(&w).to_f64());
            check(value.is_finite(), "a component of the zero", value, "a finite number")?;
            let is_good = deviation >= 0.0 && deviation.is_finite();
            check(is_good, "a standard deviation of the zero", deviation, "a finite number, 0 or more")?;
        }
        check(from.is_finite(), "the beginning of the zero", from, "a finite number of seconds")?;
        check(to >= from && to.is_finite(), "the end of the zero", to, "a finite time, not before its beginning")?;
        Ok(Self { wrench, sigma, noise: None, count: 0, from, to, arrived: from })
    }

    /// Mean of the samples, N and N m.
    pub fn wrench(&self) -> Wrench<T> {
        self.wrench
    }

    /// Standard deviation of the mean, N and N m, from the means of batches: noise whose neighbours are correlated, and
    /// drift within the window, are in it.
    pub fn sigma(&self) -> Wrench<T> {
        self.sigma
    }

    /// Standard deviation of a sample about the mean, N and N m, where it was measured.
    pub fn noise(&self) -> Option<Wrench<T>> {
        self.noise
    }

    /// How many samples it is of; 0 where it is known from elsewhere.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Time of the first sample, s.
    pub fn from(&self) -> f64 {
        self.from
    }

    /// Time of the last sample, s.
    pub fn to(&self) -> f64 {
        self.to
    }

    /// The time that it is of, s: the middle of the window.
    pub fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }
}
