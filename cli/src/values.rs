//! The values of options, read and checked.

use clap::{Arg, ArgAction};
use rod_files::{LargestStress, Speed};
use std::path::PathBuf;
use vibrissa::hw::recording::{Constant, Role};
use vibrissa::plan::Rectangle;
use vibrissa::reconstruct::Friction;

/// In place of the global `--quiet` where there is no report: taken, not listed.
pub fn no_quiet() -> Arg {
    Arg::new("quiet").long("quiet").short('q').action(ArgAction::SetTrue).hide(true)
}

/// A seed of noise.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// A number that counts from 1; whether there are so many shows later.
pub fn number(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "expected a whole number, at least 1".to_owned())
}

/// A number that counts from 0; whether there are so many shows later.
pub fn index(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "expected a whole number, 0 or larger".to_owned())
}

/// The speed of a clamp that moves, m/s: a number, or one with a unit.
pub fn speed(text: &str) -> Result<f64, String> {
    let speed = text.parse::<Speed>()?.where_it_moves().map_err(|error| error.to_string())?;
    if speed > 0.0 && speed.is_finite() { Ok(speed) } else { Err("expected a speed greater than 0".into()) }
}

/// A number beyond 0.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number greater than 0".to_owned())
}

/// A stress, or any.
pub fn largest_stress(text: &str) -> Result<LargestStress, String> {
    match text {
        "any" => Ok(LargestStress::Any),
        _ => positive(text).map(LargestStress::Given).map_err(|expected| format!("{expected}, Pa, or `any`")),
    }
}

/// The corners of a box.
pub fn rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers = text.split(',').map(|text| text.trim().parse().ok().filter(|number: &f64| number.is_finite()));
    match numbers.collect::<Option<Vec<f64>>>().as_deref() {
        Some(&[x, y, to_x, to_y]) if x < to_x && y < to_y => Ok(Rectangle { low: [x, y], high: [to_x, to_y] }),
        _ => Err("expected x0,y0,x1,y1, m: the lower left corner and the upper right one".to_owned()),
    }
}

/// A number that is not negative.
pub fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "expected a number, 0 or larger".to_owned())
}

/// What is known of friction: none, estimate, a coefficient, or a coefficient with its standard deviation.
pub fn friction(text: &str) -> Result<Friction, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
    match text {
        "none" => Ok(Friction::None),
        "estimate" => Ok(Friction::Estimate),
        _ => {
            let (mu, sigma) = text.split_once("+-").unwrap_or((text, "0"));
            let known = number(mu).zip(number(sigma)).map(|(mu, sigma)| Friction::Known { mu, sigma });
            known.ok_or_else(|| {
                "expected a coefficient, 0 or larger, as 0.1 or 0.1+-0.02, `estimate` or `none`".to_owned()
            })
        }
    }
}

/// Several numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Values(pub Vec<f64>);

/// Most numbers of an option: each is a scan of milliseconds at least.
const MOST_VALUES: usize = 100_000;

/// Numbers with commas between them, or evenly spread ones as from:to:count.
pub fn values(text: &str) -> Result<Values, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let parts: Vec<&str> = text.split(':').collect();
    let values = match parts[..] {
        [from, to, count] => {
            let count = count.trim().parse().ok().filter(|count| (2..=MOST_VALUES).contains(count));
            number(from).zip(number(to)).zip(count).map(|((from, to), count)| {
                let share = |k: usize| k as f64 / (count - 1) as f64;
                (0..count).map(|k| from * (1.0 - share(k)) + to * share(k)).collect()
            })
        }
        [list] => list.split(',').map(number).collect(),
        _ => None,
    };
    let expected = || {
        format!(
            "expected from:to:count, two numbers and 2 to {MOST_VALUES}, or finite numbers with commas between them"
        )
    };
    values.map(Values).ok_or_else(expected)
}

/// An angle.
pub fn degrees(text: &str) -> Result<f64, String> {
    let angle = text.parse().ok().filter(|angle: &f64| angle.is_finite());
    angle.ok_or_else(|| "expected a finite number of degrees".to_owned())
}

/// A directory of results: several files have no place on standard output.
pub fn directory(text: &str) -> Result<PathBuf, String> {
    match text {
        "-" => Err("several files cannot go to standard output, expected a directory".to_owned()),
        _ => Ok(PathBuf::from(text)),
    }
}

/// A column and its unit.
pub fn pair(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.rsplit_once('=').ok_or("expected two names with = between them")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// Before what concerns the table of a stage alone.
pub const STAGE: &str = "stage:";

/// A meaning and its column, or its value.
#[derive(Clone, Debug)]
pub struct Meaning {
    pub role: Role,
    pub place: Place,
    /// Whether the table of the stage is meant.
    pub of_stage: bool,
}

/// Where the value of a meaning is.
#[derive(Clone, Debug)]
pub enum Place {
    /// In a column of this name.
    Column(String),
    /// In none, because it stays the same.
    Constant(Constant),
}

/// A meaning and its column, or the value of a coordinate or the angle of the clamp.
pub fn meaning(text: &str) -> Result<Meaning, String> {
    let (name, column) = text.split_once('=').ok_or("expected two names with = between them")?;
    let (of_stage, name) = name.strip_prefix(STAGE).map_or((false, name), |name| (true, name));
    let role = Role::of_name(name).ok_or_else(|| {
        format!("`{name}` means nothing, expected x0, y0, phi0, f0x, f0y, m0z, t or another name of docs/recordings.md")
    })?;
    let is_pose = matches!(role, Role::X0 | Role::Y0 | Role::Phi0);
    let constant = Constant::parse(role, column).filter(|_| is_pose);
    let place = constant.map_or_else(|| Place::Column(column.to_owned()), Place::Constant);
    Ok(Meaning { role, place, of_stage })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_is_a_length_per_second() {
        assert_eq!((speed("10 mm/s"), speed("0.01")), (Ok(0.01), Ok(0.01)));
        assert!(speed("10 deg/s").is_err_and(|why| why.contains("expected a length per second: the clamp moves")));
        assert!(speed("0 mm/s").is_err() && speed("nan").is_err());
    }

    #[test]
    fn values_are_a_list_or_evenly_spread() {
        assert_eq!(values("0.1:0.3:3"), Ok(Values(vec![0.1, 0.2, 0.3])));
        assert_eq!(values("90, -30"), Ok(Values(vec![90.0, -30.0])));
        assert_eq!(values("5"), Ok(Values(vec![5.0])));
        for wrong in ["", "1:2", "1:2:1", "1:2:3:4", "1,,2", "nan", "1:inf:3", "1:2:2.5"] {
            assert!(values(wrong).is_err_and(|why| why.starts_with("expected from:to:count")), "{wrong}");
        }
    }
}
