//! The legs of a path, and the poses to report on each.

use crate::continuation::step::SAME_POSE;
use crate::error::ContactError;
use crate::path::Path;
use crate::scene::way::Way;
use rod_core::Units;
use std::sync::Arc;

/// Largest number of reported states. With more, neighbouring poses differ by less than the rounding of the path parameter.
const MOST_STEPS: f64 = 1e15;

/// A leg of the path, and the states to report on it.
#[derive(Clone, Debug)]
pub(super) struct Leg {
    pub way: Way,
    /// Distance, dimensionless, and number of the states, that at the start included.
    pub step: f64,
    pub reports: usize,
}

impl Leg {
    /// States at 0, `step`, 2 `step`, ... of the path's parameter, and at its end.
    pub fn new(way: Way, step: f64, length: f64) -> Result<Self, ContactError> {
        let wrong = ContactError::Step { value: step };
        if !(step.is_finite() && step > 0.0) {
            return Err(wrong);
        }
        let (step, length) = (way.tau(step, length), way.length());
        // a path that is a whole number of steps long but for rounding reports its end once
        let steps = (length / step * (1.0 + 1e-12)).floor();
        if steps > MOST_STEPS {
            return Err(wrong);
        }
        let beyond = steps * step < length - SAME_POSE;
        Ok(Self { way, step, reports: steps as usize + 1 + usize::from(beyond) })
    }
}

/// The legs of a path.
pub(super) fn legs(path: impl Path + 'static, units: Units) -> Result<Vec<Way>, ContactError> {
    let path: Arc<dyn Path> = Arc::new(path);
    Way::legs(&path, units)
}
