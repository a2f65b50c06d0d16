//! The reading of a sensor without load.

use super::TareError;
use crate::sample::{Component, Number, Wrench};

/// The reading of a sensor without load, with its standard deviation.
///
/// ```
/// use rod_hw::{Wrench, Zero};
/// let wrench = Wrench { force: [0.1, 0.0, 0.0], torque: [0.0; 3] };
/// let zero = Zero::known(wrench, Wrench { force: [1e-3; 3], torque: [1e-5; 3] }, 2.0)?;
/// assert_eq!(zero.wrench(), wrench);
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero<T = f64> {
    pub(super) wrench: Wrench<T>,
    pub(super) sigma: Wrench<T>,
    pub(super) count: usize,
    pub(super) arrived: f64,
}

impl<T: Number> Zero<T> {
    /// A zero known from elsewhere: its value and standard deviation (N and N m), and when it was measured (s) on the clock of
    /// the host.
    ///
    /// # Errors
    /// [`TareError::Number`] where a number is not finite, or a deviation negative.
    pub fn known(wrench: Wrench<T>, sigma: Wrench<T>, arrived: f64) -> Result<Self, TareError> {
        let check = |is_good: bool, field, value, expected| {
            if is_good { Ok(()) } else { Err(TareError::Number { field, value, expected }) }
        };
        for component in Component::ALL {
            let [value, deviation] = [wrench, sigma].map(|w| component.of(&w).to_f64());
            check(value.is_finite(), "a component of the zero", value, "a finite number")?;
            let is_good = deviation >= 0.0 && deviation.is_finite();
            check(is_good, "a standard deviation of the zero", deviation, "a finite number, 0 or more")?;
        }
        check(arrived.is_finite(), "the time of the zero", arrived, "a finite number of seconds")?;
        Ok(Self { wrench, sigma, count: 0, arrived })
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

    /// How many samples it is of; 0 where it is known from elsewhere.
    pub fn count(&self) -> usize {
        self.count
    }
}
