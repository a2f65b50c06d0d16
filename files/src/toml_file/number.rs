//! Numbers: those of values, those that are written in a way that TOML does not take, with a decimal comma or in quotes, and angles in
//! degrees that may be mistakes: those that look like radians, and clamps turned many times.

use super::error::{Fault, visit};
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use toml::Value;
use toml::de::DeTable;

/// The number that a value is, written with a decimal point or without.
pub(crate) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Where a number with a decimal comma stands on the line on which TOML found a mistake, and what to write instead.
pub(super) fn decimal_comma(text: &str, at: usize) -> Option<(Range<usize>, String)> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[start..].lines().next()?;
    let value = line.find('=')? + 1;
    let code = line[value..].split('#').next()?;
    let from = value + code.len() - code.trim_start().len();
    let written = code.trim();
    let in_list = written.starts_with('[');
    let (place, found) = if in_list {
        // `[0,05, 1]`: TOML stops at the zero, `[0,5, 1,5]` is a list of four and no mistake here.
        let found = written.trim_matches(['[', ']']).split(", ").find(|number| with_point(number).is_some())?;
        (line.find(found)?, found)
    } else {
        (from, written)
    };
    let point = with_point(found)?;
    let span = start + place..start + place + found.len();
    Some((span, format!("the value is `{found}`, expected a decimal point: `{point}`")))
}

/// The number with a point in place of its only comma.
fn with_point(written: &str) -> Option<String> {
    let (whole, fraction) = written.trim().split_once(',')?;
    let digits = |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit());
    let point = format!("{whole}.{fraction}");
    (digits(whole.trim_start_matches(['-', '+'])) && digits(fraction) && point.parse::<f64>().is_ok()).then_some(point)
}

/// What to do with the number in the message `the value is the text "0.5", expected a number`.
pub(super) fn hint_for_quoted_number(message: &str) -> Option<String> {
    let text = message.strip_prefix("the value is the text \"")?.strip_suffix("\", expected a number")?;
    let number = if text.parse::<f64>().is_ok() { text.to_owned() } else { with_point(text)? };
    Some(format!("write it without quotes: {number}"))
}

/// A hint for a list of too many numbers where two belong: `[0,5, 1,5]` has four.
pub(crate) fn comma_in_list(found: usize) -> &'static str {
    if (3..=4).contains(&found) { "; decimals have a point, as in [0.5, 1.5]" } else { "" }
}

/// The fields that are angles in degrees, wherever they stand. Not `step_angle`, which may well be 1.57 degrees.
const ANGLES: [&str; 7] = ["angle", "angle_to", "turn", "from_angle", "to_angle", "rotation", "turns_from"];

/// So near to a multiple of pi/2 a number of degrees is taken for radians: as near as that written with three digits behind
/// the point. With a larger one, degrees that are meant would be warned of.
const NEAR: f64 = 1e-3;

/// Angle of the clamp, degrees, beyond which it is warned of: two turns.
const MOST_TURNED: f64 = 720.0;

/// A warning for each angle near pi/2, pi, 3 pi/2 or 2 pi of either sign, and for a clamp turned more than twice.
pub(super) fn suspicious(table: &DeTable<'_>, text: &str) -> Vec<Fault> {
    let mut warnings = Vec::new();
    visit(table, "", &mut |span, path| {
        let name = path.rsplit('.').next().unwrap_or(path);
        // that of the key is no number
        let value = text.get(span.clone()).and_then(|text| text.replace('_', "").parse::<f64>().ok());
        let Some(value) = value.filter(|_| ANGLES.contains(&name)) else { return };
        if let Some(quarters) = quarters(value) {
            let meant = 90 * quarters;
            warnings.push(Fault::new(span, format!("{name} is {value} degrees; is {meant} degrees meant?")));
        } else if path.starts_with("sweep.") && value.abs() > MOST_TURNED {
            let turned = format!("{name} is {value} degrees, more than two turns of the clamp; is that meant?");
            warnings.push(Fault::new(span, turned));
        }
    });
    warnings
}

/// How many right angles a number of radians is, if it is a whole number of them other than 0, at most a turn.
fn quarters(value: f64) -> Option<i32> {
    let quarters = (value / FRAC_PI_2).round();
    let near = (value - quarters * FRAC_PI_2).abs() < NEAR;
    (near && (1.0..=4.0).contains(&quarters.abs())).then_some(quarters as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_becomes_a_point() {
        let hint = |text: &str| decimal_comma(text, text.find(',').unwrap());
        let (span, message) = hint("[rod]\nlength = 0,5  # m\n").unwrap();
        assert_eq!((span, message.as_str()), (15..18, "the value is `0,5`, expected a decimal point: `0.5`"));
        assert_eq!(hint("a = -1,5e-3").unwrap().0, 4..11);
        assert_eq!(hint("from = [1, 0,05]").unwrap().0, 11..15);
        assert!(hint("a = 1, b = 2").is_none() && hint("a = x,5").is_none() && hint("a = [1, 2 3]").is_none());
    }

    #[test]
    fn quotes_go() {
        let message =
            |text: &str| hint_for_quoted_number(&format!("the value is the text \"{text}\", expected a number"));
        assert_eq!(message("0.5").unwrap(), "write it without quotes: 0.5");
        assert_eq!(message("0,5").unwrap(), "write it without quotes: 0.5");
        assert!(message("long").is_none());
    }

    #[test]
    fn right_angles_in_radians() {
        for (text, expected) in [("1.5708", 1), ("-3.142", -2), ("4.712", 3), ("6.283", 4)] {
            assert_eq!(quarters(text.parse().unwrap()), Some(expected), "{text}");
        }
        for degrees in [0.0, 0.0005, 1.5, 1.573, 3.0, 7.854, 90.0, f64::NAN, f64::INFINITY] {
            assert_eq!(quarters(degrees), None, "{degrees}");
        }
    }
}
