//! What a tare window must be like.

use super::TareError;
use crate::sample::{Component, Wrench};

const POSITIVE: &str = "a positive number";

/// What a tare window must be like to give a zero.
///
/// ```
/// use rod_hw::{TareLimits, Wrench};
/// let limits = TareLimits::new(0.5, Wrench { force: [2e-3; 3], torque: [1e-4; 3] })?;
/// assert!(TareLimits::new(0.0, limits.change()).is_err());
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TareLimits {
    shortest: f64,
    change: Wrench,
}

impl TareLimits {
    /// A window of so many seconds at least, within which no component changes by more than `change` (N and N m; infinite
    /// where it does not matter): by drift, by a step, or there and back. Choose what is small beside the rod's reactions.
    ///
    /// # Errors
    /// [`TareError::Number`] where a limit is not positive.
    pub fn new(shortest: f64, change: Wrench) -> Result<Self, TareError> {
        if !(shortest > 0.0 && shortest.is_finite()) {
            return Err(TareError::Number { field: "the shortest tare window", value: shortest, expected: POSITIVE });
        }
        positive("the largest change within a tare window", &change)?;
        Ok(Self { shortest, change })
    }

    /// How long a window is at least, s.
    pub fn shortest(&self) -> f64 {
        self.shortest
    }

    /// The largest change within a window, N and N m.
    pub fn change(&self) -> Wrench {
        self.change
    }
}

fn positive(field: &'static str, limits: &Wrench) -> Result<(), TareError> {
    match Component::ALL.map(|c| c.of(limits)).into_iter().find(|limit| limit.is_nan() || *limit <= 0.0) {
        Some(value) => Err(TareError::Number { field, value, expected: POSITIVE }),
        None => Ok(()),
    }
}
