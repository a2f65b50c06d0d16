//! The legs of a path, and the poses to report on each.

use crate::error::ContactError;
use crate::limits::LIMITS;
use crate::path::Path;
use crate::scene::way::Way;
use rod_core::Units;
use std::collections::VecDeque;
use std::sync::Arc;

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
        if steps > LIMITS.sweep.most_states {
            return Err(wrong);
        }
        let beyond = steps * step < length - LIMITS.step.same_pose;
        Ok(Self { way, step, reports: steps as usize + 1 + usize::from(beyond) })
    }
}

/// How far a sweep has come along the legs of its path, and what it reports next.
#[derive(Debug)]
pub(super) struct Course {
    /// Number of the present leg, and the parameter of the whole path where it begins.
    pub leg: usize,
    pub before: f64,
    /// Distance of reported states, dimensionless, how many there are on this leg, and how many have been.
    step: f64,
    reports: usize,
    reported: usize,
    ahead: VecDeque<Leg>,
}

impl Course {
    /// One leg, of which so many states are reported.
    pub fn single(step: f64, reports: usize) -> Self {
        Self { leg: 0, before: 0.0, step, reports, reported: 0, ahead: VecDeque::new() }
    }

    /// The same with other legs behind it.
    pub fn followed_by(self, ahead: VecDeque<Leg>) -> Self {
        Self { ahead, ..self }
    }

    /// One leg, of which only the end is reported.
    pub fn to_end(length: f64) -> Self {
        Self { reported: 1, ..Self::single(length, 2) }
    }

    /// Whether a state of this leg is still to be reported.
    pub fn is_due(&self) -> bool {
        self.reported < self.reports
    }

    /// Whether none has been.
    pub fn is_new(&self) -> bool {
        self.reported == 0
    }

    /// The pose to report next on a leg of this length; the last one may be beyond the end by rounding.
    pub fn next_pose(&self, length: f64) -> f64 {
        (self.step * self.reported as f64).min(length)
    }

    /// The state that is due has been reported, or passed over.
    pub fn pass(&mut self) {
        self.reported += 1;
    }

    /// Whether the present leg is the last one.
    pub fn is_last(&self) -> bool {
        self.ahead.is_empty()
    }

    /// Goes on to the next leg, if there is one, from the end of the present one, which is so long (as [`before`](Self::before)).
    pub fn next_leg(&mut self, passed: f64) -> Option<Way> {
        let Leg { way, step, reports } = self.ahead.pop_front()?;
        self.before += passed;
        self.leg += 1;
        // the first pose of a leg has been reported with the last leg
        (self.step, self.reports, self.reported) = (step, reports, 1);
        Some(way)
    }
}

/// The legs of a path.
pub(super) fn legs(path: impl Path + 'static, units: Units) -> Result<Vec<Way>, ContactError> {
    let path: Arc<dyn Path> = Arc::new(path);
    Way::legs(&path, units)
}
