//! Why a window gives no zero.

use crate::sample::{Component, Quality};

/// Why a window of samples gives no zero.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TareError {
    /// The window does not last long enough.
    #[error(
        "the tare window lasts {seconds:.3} s, expected {shortest} s or more; let it run longer before the rod touches"
    )]
    Short {
        /// How long it lasts, s.
        seconds: f64,
        /// How long it should, s.
        shortest: f64,
    },
    /// Too few samples for statistics.
    #[error("the tare window has {count} samples, expected {fewest} or more; let it run longer")]
    Few {
        /// How many it has.
        count: usize,
        /// How many it should have.
        fewest: usize,
    },
    /// A sample in it does not mean what it says.
    #[error(
        "the sample at {t} s in the tare window is flagged {quality}; tare again when the sensor has no fault and no load"
    )]
    Unusable {
        /// Its time, s.
        t: f64,
        /// The flags that forbid its use.
        quality: Quality,
    },
    /// The device or the connection restarted within it.
    #[error("the device restarted at {t} s, within the tare window; tare with samples after that")]
    Restarted {
        /// When, s.
        t: f64,
    },
    /// A sample is no number.
    #[error("{component} at {t} s is {value}, expected a finite number; leave such samples out before the tare")]
    NotFinite {
        /// Which component.
        component: Component,
        /// Its time, s.
        t: f64,
        /// Its value.
        value: f64,
    },
    /// Time does not go on.
    #[error("a sample at {t} s comes after one at {before} s, expected increasing times")]
    Time {
        /// Its time, s.
        t: f64,
        /// The time before, s.
        before: f64,
    },
    /// The zero moves steadily.
    #[error(
        "{component} drifts by {change:.3e} +- {sigma:.1e} {si} over the {seconds:.3} s of the tare window, expected at most \
         {limit:.1e}; let the sensor warm up, or unload it fully", si = .component.si()
    )]
    Drift {
        /// Which component.
        component: Component,
        /// By how much over the window, N or N m.
        change: f64,
        /// Standard error of that.
        sigma: f64,
        /// The largest change accepted.
        limit: f64,
        /// How long the window lasts, s.
        seconds: f64,
    },
    /// The load changes.
    #[error(
        "{component} changes by {change:.3e} {si} about {t:.3} s, within the tare window, expected at most {limit:.1e}; keep \
         the rod clear of everything while taring", si = .component.si()
    )]
    Change {
        /// Which component.
        component: Component,
        /// By how much, N or N m.
        change: f64,
        /// When, s.
        t: f64,
        /// The largest change accepted.
        limit: f64,
    },
    /// The standard deviation of the zero is too large to detect a drift.
    #[error(
        "the zero of {component} has a standard deviation of {sigma:.1e} {si}, more than the change of {limit:.1e} that the \
         window is to be free of; let it run longer, or accept a larger change", si = .component.si()
    )]
    Noisy {
        /// Which component.
        component: Component,
        /// Standard deviation of its mean, N or N m.
        sigma: f64,
        /// The largest change accepted.
        limit: f64,
    },
    /// A number of the limits or of a known zero is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Number {
        /// Which one.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
}
