//! Arguments of a simulation that are not possible.

use crate::scene::MOST_STATES;
use std::fmt;

/// An argument that a scene cannot be simulated with. Front ends call arguments by different names: [`message`](Self::message) takes theirs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulationArgument {
    /// A rate or speed that is none.
    NotPositive {
        /// Which one.
        what: &'static str,
        /// Its value as given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A speed in the unit of another motion.
    SpeedUnit {
        /// The speed as written.
        speed: String,
        /// What is expected, and why.
        expected: &'static str,
    },
    /// More samples than a sweep may report.
    TooMany {
        /// Samples in a second.
        rate: f64,
        /// Speed of the clamp.
        speed: f64,
        /// How many samples these are.
        samples: f64,
        /// Length of the path.
        length: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A channel has no noise whose standard deviation could be written.
    NoSigma {
        /// Which one.
        channel: &'static str,
    },
}

impl SimulationArgument {
    /// What is wrong, and what is expected. `name` gives the name that a front end has for the argument `rate`, `speed` or `sigmas`.
    pub fn message(&self, name: impl Fn(&'static str) -> String) -> String {
        match self {
            Self::NotPositive { what, value, unit } => {
                format!("{} is {value}, expected a positive, finite number of {unit}", name(what))
            }
            Self::SpeedUnit { speed, expected } => format!("{} is {speed}, expected {expected}", name("speed")),
            Self::TooMany { rate, speed, samples, length, unit } => format!(
                "{} {rate} Hz at {} {speed} {unit}/s asks for {samples:.1e} samples on a path of {length:.6} {unit}, expected at most \
                 {MOST_STATES:e}; lower the rate, raise the speed or cut the path",
                name("rate"),
                name("speed")
            ),
            Self::NoSigma { channel } => format!(
                "{}: the noise model gives {channel} no standard deviation, expected white or AR(1) noise or a quantum in every channel \
                 where standard deviations are to be written",
                name("sigmas")
            ),
        }
    }
}

impl fmt::Display for SimulationArgument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message(str::to_owned))
    }
}

impl std::error::Error for SimulationArgument {}
