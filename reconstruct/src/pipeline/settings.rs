//! Settings of a reconstruction.

use crate::friction::Friction;
use crate::kink::KinkOptions;
use crate::scan::noise_estimate::ChannelNoise;
use crate::systematic::{Budget, Known, Source};

/// Settings of a reconstruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Noise of f0x, f0y (N) and m0z (N m), if it is known better than from the scan itself.
    pub noise: Option<[ChannelNoise; 3]>,
    /// Upper bound of the expected number of false alarms of the search for kinks, per scan.
    pub false_alarms: f64,
    /// Largest standard deviation of a contact point across the contour, in lengths of the rod. Less certain points are left out.
    pub largest_sigma: f64,
    /// How large the errors may be that all samples share: those of an ordinary laboratory ([`Budget::laboratory`]) if none is given.
    /// [`Budget::NONE`] takes samples and rod as they are.
    pub budget: Option<Budget>,
    /// What a calibration says of single sources of error, in place of the budget of these sources.
    pub known: Known,
    /// What is known of friction at the contacts.
    pub friction: Friction,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            noise: None,
            false_alarms: KinkOptions::default().false_alarms,
            largest_sigma: 0.02,
            budget: None,
            known: Known::NOTHING,
            friction: Friction::None,
        }
    }
}

/// Why a scan cannot be reconstructed at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReconstructError {
    /// Too few samples.
    #[error(
        "{usable} usable samples of {samples}, expected at least {fewest}: along one path, each beyond the one before"
    )]
    TooFew {
        /// How many of them can be used.
        usable: usize,
        /// How many there are.
        samples: usize,
        /// The smallest number.
        fewest: usize,
    },
    /// A standard deviation of the budget that is not possible.
    #[error("the budget of the {of} is {value}, expected a finite number, 0 or larger")]
    Budget {
        /// Of which source.
        of: Source,
        /// Its value.
        value: f64,
    },
    /// A value or standard deviation of a calibration that is not possible.
    #[error("the known value of the {of} is {value}, expected a finite number and a standard deviation, 0 or larger")]
    Known {
        /// Of which source.
        of: Source,
        /// The number that is wrong.
        value: f64,
    },
    /// A coefficient of friction, or its standard deviation, that is not possible.
    #[error("friction is {value}, expected a finite number, 0 or larger")]
    Friction {
        /// The number that is wrong.
        value: f64,
    },
    /// A natural curvature is known besides that which the model of the rod has.
    #[error("a natural curvature is known besides that of the rod's model, expected it in the model alone")]
    NaturalCurvature,
    /// A setting that is not possible.
    #[error("{what} is {value}, expected a positive, finite number")]
    Setting {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Checks a budget and a calibration.
pub(super) fn possible(budget: &Budget, known: &Known) -> Result<(), ReconstructError> {
    if let Some((of, value)) = budget.fault() {
        return Err(ReconstructError::Budget { of, value });
    }
    if let Some((of, value)) = known.fault() {
        return Err(ReconstructError::Known { of, value });
    }
    Ok(())
}

/// Checks settings that must be positive, finite numbers.
pub(super) fn positive(settings: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), ReconstructError> {
    match settings.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some((what, value)) => Err(ReconstructError::Setting { what, value }),
        None => Ok(()),
    }
}
