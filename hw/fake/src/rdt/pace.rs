//! When the next record is due.

use std::time::{Duration, Instant};

/// Behind by so much the pace is not made up for, s: a machine that slept does not owe the records of the night.
const FORGIVEN: f64 = 0.5;

/// A steady pace: sleeps, and makes up for sleeping too long.
#[derive(Debug)]
pub(super) struct Pace {
    from: Instant,
    steps: u32,
    period: f64,
}

impl Pace {
    pub(super) fn new(period: f64) -> Self {
        Self { from: Instant::now(), steps: 0, period }
    }

    /// Begins anew after so many seconds.
    pub(super) fn delay(&mut self, seconds: f64) {
        let delay = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        (self.from, self.steps) = (Instant::now() + delay, 0);
    }

    /// How long until the next step is due.
    pub(super) fn left(&mut self) -> Duration {
        if self.steps == u32::MAX {
            self.delay(0.0);
        }
        let due = self.from + Duration::try_from_secs_f64(self.period * f64::from(self.steps)).unwrap_or_default();
        let now = Instant::now();
        if now.saturating_duration_since(due).as_secs_f64() > FORGIVEN {
            self.delay(0.0);
        }
        due.saturating_duration_since(now)
    }

    /// A step has passed.
    pub(super) fn step(&mut self) {
        self.steps += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_and_made_up_for() {
        let mut pace = Pace::new(10.0);
        assert_eq!(pace.left(), Duration::ZERO);
        pace.step();
        let left = pace.left().as_secs_f64();
        assert!(left > 5.0 && left <= 10.0, "{left}");
        pace.delay(100.0);
        assert!(pace.left().as_secs_f64() > 50.0);
        // no pace at all
        let mut pace = Pace::new(0.0);
        pace.step();
        assert_eq!(pace.left(), Duration::ZERO);
    }
}
