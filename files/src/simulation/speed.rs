//! The speed of a clamp, as it is written.

use super::SimulationArgument;
use crate::Scene;
use std::fmt;
use std::str::FromStr;
use vibrissa::hw::{Dimension, Unit};

/// The speed of a clamp: a number in the unit of what moves (m/s, or rad/s where the clamp only turns), or a number with a unit, as `1 mm/s` or
/// `10 deg/s`.
///
/// ```
/// use rod_files::Speed;
/// assert_eq!("10 deg/s".parse::<Speed>()?.to_string(), "10 deg/s");
/// assert!("10 kg/s".parse::<Speed>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Speed {
    number: f64,
    unit: Option<Unit>,
}

impl Speed {
    /// In m/s, or rad/s where the clamp of the scene only turns.
    ///
    /// # Errors
    /// [`SimulationArgument::SpeedUnit`] where the unit is of the other motion.
    pub fn of(&self, scene: &Scene) -> Result<f64, SimulationArgument> {
        self.where_it(scene.turns_only())
    }

    /// In m/s, of a clamp that moves.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn where_it_moves(&self) -> Result<f64, SimulationArgument> {
        self.where_it(false)
    }

    fn where_it(&self, turns: bool) -> Result<f64, SimulationArgument> {
        let Some(unit) = self.unit else { return Ok(self.number) };
        if (unit.dimension == Dimension::Angle) == turns {
            return Ok(self.number * unit.factor);
        }
        let expected =
            if turns { "an angle per second: the clamp only turns" } else { "a length per second: the clamp moves" };
        Err(SimulationArgument::SpeedUnit { speed: self.to_string(), expected })
    }
}

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected a number, or a number with a unit as 1 mm/s or 10 deg/s".to_owned();
        let text = text.trim();
        let split = text.find(|letter: char| letter.is_whitespace()).unwrap_or(text.len());
        let number = text[..split].parse().map_err(|_| expected())?;
        let unit = match text[split..].trim() {
            "" => None,
            unit => {
                let unit = unit.strip_suffix("/s").ok_or_else(expected)?;
                let known = [Dimension::Length, Dimension::Angle].map(|of| Unit::parse(unit, of).ok());
                Some(known.into_iter().flatten().next().ok_or_else(expected)?)
            }
        };
        Ok(Self { number, unit })
    }
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unit {
            None => write!(f, "{}", self.number),
            Some(unit) => write!(f, "{} {}/s", self.number, unit.name),
        }
    }
}
