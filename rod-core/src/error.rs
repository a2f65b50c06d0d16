//! What can be wrong with a rod, a load or a solve.

/// Errors of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RodError {
    /// A quantity that must be a positive, finite number is not.
    #[error("{what} is {value}, expected a positive, finite number")]
    NotPositive {
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
    },
    /// A quantity that must be finite is not.
    #[error("{what} is {value}, expected a finite number")]
    NotFinite {
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
    },
    /// A wire that is thicker than it is long: no rod, and most often a length in m with a diameter in mm.
    #[error("diameter is {diameter:?} m, expected at most the length, {length:?} m")]
    TooThick {
        /// Diameter as given, m.
        diameter: f64,
        /// Length as given, m.
        length: f64,
    },
    /// The arc lengths of the loads do not grow from the clamp to the tip.
    #[error(
        "load {index} acts at arc length {s}, expected a value from {least} to {most}: loads are ordered from clamp to tip"
    )]
    LoadOrder {
        /// Number of the load, from 0.
        index: usize,
        /// Where it acts.
        s: f64,
        /// Arc length of the load before, or 0.
        least: f64,
        /// Length of the rod.
        most: f64,
    },
    /// An integrator of differential equations gave up.
    #[cfg(feature = "std")]
    #[error("the integration stopped at arc length {s}: {reason}")]
    Integration {
        /// How far it came.
        s: f64,
        /// Why.
        reason: String,
    },
    /// A scalar root-finding failed.
    #[cfg(feature = "std")]
    #[error("no root of {what} found: {reason}")]
    NoRoot {
        /// Of which function.
        what: &'static str,
        /// Why.
        reason: String,
    },
}

/// An error that says `what` where `value` is not finite.
#[cfg(feature = "std")]
pub(crate) fn finite(what: &'static str, value: f64) -> Result<(), RodError> {
    if value.is_finite() { Ok(()) } else { Err(RodError::NotFinite { what, value }) }
}
