//! The motion of the clamp as an argument of the command line.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use vibrissa::hw::{Dimension, Unit};

/// How the clamp is moved: `constant:SPEED` along the path of a scene, from the first sample on, in m/s (rad/s where the clamp
/// only turns); or `table:FILE`, poses with their times.
///
/// ```
/// use rod_files::StageSpec;
/// assert_eq!("constant:1e-3".parse(), Ok(StageSpec::Constant(1e-3)));
/// let wrong = "constant:0".parse::<StageSpec>().unwrap_err().to_string();
/// assert!(wrong.starts_with("the speed in `constant:0` is `0`, expected a positive, finite number"), "{wrong}");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum StageSpec {
    /// m/s, or rad/s where the clamp only turns.
    Constant(f64),
    /// The file with columns t (s), x0, y0 (m), phi0 (rad), on the sensor's clock.
    Table(PathBuf),
}

/// Why a text is not a stage.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StageSpecError {
    /// Its form is unknown.
    #[error("`{text}` is no stage, expected constant:SPEED (m/s, or rad/s where the clamp only turns) or table:FILE")]
    Form {
        /// The text.
        text: String,
    },
    /// The speed is not possible.
    #[error(
        "the speed in `{text}` is `{found}`, expected a positive, finite number of m/s, or rad/s where the clamp only turns"
    )]
    Speed {
        /// The text.
        text: String,
        /// The text in its place.
        found: String,
    },
}

impl FromStr for StageSpec {
    type Err = StageSpecError;

    fn from_str(text: &str) -> Result<Self, StageSpecError> {
        let owned = || text.to_owned();
        if let Some(found) = text.strip_prefix("constant:") {
            let speed = found.parse::<f64>().ok().filter(|speed| speed.is_finite() && *speed > 0.0);
            return speed
                .map(Self::Constant)
                .ok_or_else(|| StageSpecError::Speed { text: owned(), found: found.to_owned() });
        }
        match text.strip_prefix("table:") {
            Some(file) if !file.is_empty() => Ok(Self::Table(file.into())),
            _ => Err(StageSpecError::Form { text: owned() }),
        }
    }
}

/// Delay of a stage's clock, s: a pose that the table of the stage has at time t is that of the clamp at t + delay on the sensor's clock. It is
/// positive if the stage's clock began after the sensor's. As text a number with a unit, `120 ms`, or a number of seconds.
///
/// ```
/// use rod_files::StageDelay;
/// assert_eq!("-120 ms".parse::<StageDelay>()?.seconds(), -0.12);
/// assert_eq!(StageDelay::new(0.12)?.to_string(), "0.12 s");
/// # Ok::<(), rod_files::StageDelayError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageDelay(f64);

/// Why a text or a number is not a delay.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the delay is `{found}`, expected a finite time as \"120 ms\" or \"-2.5 s\", or a number of seconds")]
pub struct StageDelayError {
    /// The text.
    found: String,
}

impl StageDelay {
    /// From seconds.
    ///
    /// # Errors
    /// [`StageDelayError`] if it is not finite.
    pub fn new(seconds: f64) -> Result<Self, StageDelayError> {
        if seconds.is_finite() { Ok(Self(seconds)) } else { Err(StageDelayError { found: seconds.to_string() }) }
    }

    /// The delay, s.
    pub fn seconds(self) -> f64 {
        self.0
    }
}

impl FromStr for StageDelay {
    type Err = StageDelayError;

    fn from_str(text: &str) -> Result<Self, StageDelayError> {
        let error = || StageDelayError { found: text.to_owned() };
        let trimmed = text.trim();
        let end = trimmed.trim_end_matches(|letter: char| letter.is_alphabetic()).len();
        let number: f64 = trimmed[..end].trim_end().parse().map_err(|_| error())?;
        let factor = match &trimmed[end..] {
            "" => 1.0,
            unit => Unit::parse(unit, Dimension::Time).map_err(|_| error())?.factor,
        };
        // 120 ms is 0.12 s to the last digit
        let per_unit = (1.0 / factor).round();
        Self::new(if factor < 1.0 { number / per_unit } else { number * factor }).map_err(|_| error())
    }
}

impl fmt::Display for StageDelay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} s", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_have_units_and_signs() {
        for (text, seconds) in
            [("120 ms", 0.12), ("-120ms", -0.12), ("2.5", 2.5), ("1e-3 s", 1e-3), ("2 min", 120.0), ("0", 0.0)]
        {
            assert_eq!(text.parse::<StageDelay>().unwrap().seconds(), seconds, "{text}");
        }
        for text in ["", "ms", "5 mm", "NaN", "inf s", "1,5 s", "5 %"] {
            let error = text.parse::<StageDelay>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("the delay is `{text}`, expected a finite time")), "{error}");
        }
    }

    #[test]
    fn forms() {
        assert_eq!("table:poses.csv".parse(), Ok(StageSpec::Table("poses.csv".into())));
        for text in ["", "1e-3", "table:", "constant"] {
            let error = text.parse::<StageSpec>().unwrap_err().to_string();
            assert!(error.contains("is no stage, expected constant:SPEED"), "{error}");
        }
        for text in ["constant:", "constant:-1", "constant:inf", "constant:NaN", "constant:1 mm/s"] {
            let error = text.parse::<StageSpec>().unwrap_err().to_string();
            assert!(error.starts_with("the speed in"), "{error}");
        }
    }
}
