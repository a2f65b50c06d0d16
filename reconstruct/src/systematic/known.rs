//! What is known of the errors that all samples share from a calibration.

use super::source::{Errors, SOURCES, Source};
use rod_core::Rod;

/// What a calibration says of single sources: an estimate and its standard deviation, which take the place of 0 and of the
/// [`Budget`](crate::Budget).
///
/// A reconstruction takes these estimates off the samples, and estimates what is left from the scan itself. The sources are taken for
/// independent of each other. Where the calibration does not tell k sources apart, the standard deviation of their sum is up to sqrt(k)
/// times larger than what a reconstruction assumes.
///
/// ```
/// use rod_reconstruct::{Known, Settings, Source};
/// let known = Known::NOTHING.with(Source::ClampAngle, 8e-3, 1e-4); // rad
/// assert_eq!(known.of(Source::ClampAngle), Some((8e-3, 1e-4)));
/// let settings = Settings { known, ..Settings::default() };
/// assert!(!settings.known.is_nothing());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Value and standard deviation, in the unit of the source.
    of: [Option<(f64, f64)>; SOURCES],
}

impl Known {
    /// Nothing beyond the budget.
    pub const NOTHING: Self = Self { of: [None; SOURCES] };

    /// The same with an estimate of one source and its standard deviation, in its unit.
    #[must_use]
    pub fn with(mut self, source: Source, value: f64, sigma: f64) -> Self {
        self.of[source as usize] = Some((value, sigma));
        self
    }

    /// The estimate of one source and its standard deviation, in its unit.
    pub fn of(&self, source: Source) -> Option<(f64, f64)> {
        self.of[source as usize]
    }

    /// Whether nothing is known beyond the budget.
    pub fn is_nothing(&self) -> bool {
        self.of.iter().all(Option::is_none)
    }

    /// The first source whose value is not finite, or whose standard deviation is negative or not finite, with that number.
    pub(crate) fn fault(&self) -> Option<(Source, f64)> {
        Source::ALL.into_iter().find_map(|source| {
            let (value, sigma) = self.of(source)?;
            let wrong = if value.is_finite() { sigma } else { value };
            (!(value.is_finite() && sigma.is_finite() && sigma >= 0.0)).then_some((source, wrong))
        })
    }

    /// The values, dimensionless.
    pub(crate) fn means(&self, rod: &Rod) -> Errors {
        Errors::from_fn(|k, _| self.of[k].map_or(0.0, |known| known.0 / Source::ALL[k].unit(rod)))
    }

    /// Standard deviations, dimensionless: those given here, and the `others` where none is.
    pub(crate) fn deviations(&self, others: &Errors, rod: &Rod) -> Errors {
        Errors::from_fn(|k, _| self.of[k].map_or(others[k], |known| known.1 / Source::ALL[k].unit(rod)))
    }
}

impl Default for Known {
    fn default() -> Self {
        Self::NOTHING
    }
}
