//! The motion of the clamp as an argument of the command line.

use std::path::PathBuf;
use std::str::FromStr;

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

#[cfg(test)]
mod tests {
    use super::*;

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
