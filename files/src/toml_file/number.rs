//! Numbers: those of values, those that are written in a way that TOML does not take, with a decimal comma or in quotes, and angles in
//! degrees that may be mistakes: those that look like radians, and clamps turned many times.

use super::error::{Fault, visit};
use super::quantity;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use toml::Value;
use toml::de::{DeTable, DeValue};

/// The number that a value is, written with a decimal point or without.
pub(crate) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// The same of a value that knows where it stands.
pub(crate) fn written_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(whole) => i128::from_str_radix(whole.as_str(), whole.radix()).ok().map(|whole| whole as f64),
        _ => None,
    }
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
        let Some(written) = text.get(span.clone()).filter(|_| ANGLES.contains(&name)) else { return };
        if let Some(value) = many_radians(written) {
            let turns = value / (4.0 * FRAC_PI_2);
            let meant = format!("{name} is {value} rad, {turns:.1} turns; is \"{value} deg\" meant?");
            return warnings.push(Fault::new(span, meant));
        }
        // that of the key is no number
        let Ok(value) = written.replace('_', "").parse::<f64>() else { return };
        if let Some(quarters) = quarters(value) {
            let meant = 90 * quarters;
            warnings.push(Fault::new(span, format!("{name} is {value} degrees; is {meant} degrees meant?")));
        } else if let Some(meant) = twelfths(value, written) {
            warnings.push(Fault::new(span, format!("{name} is {value} degrees; is {meant} degrees meant?")));
        } else if let Some(meant) = converted_twice(value) {
            let twice = format!("{name} is {value} degrees; is {meant} degrees meant, converted twice?");
            warnings.push(Fault::new(span, twice));
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

/// How near to a multiple of pi/12 a number with at least as many digits behind the point is taken for radians.
const NEAR_TWELFTH: f64 = 5e-5;
/// Digits behind the point of such a number.
const DIGITS: usize = 4;

/// How many degrees a number of radians is, if it is written with four digits or more and is a multiple of pi/12 below a turn, as 0.7854.
fn twelfths(value: f64, written: &str) -> Option<i32> {
    let digits = written.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let parts = (value * 6.0 / FRAC_PI_2).round();
    let near = (value - parts * FRAC_PI_2 / 6.0).abs() < NEAR_TWELFTH;
    (digits >= DIGITS && near && (1.0..24.0).contains(&parts.abs())).then_some(15 * parts as i32)
}

/// How many degrees were converted to degrees once more: 90 became 5156.62.
fn converted_twice(value: f64) -> Option<f64> {
    let once = value.to_radians();
    let whole = once.round();
    (value.abs() > MOST_TURNED && whole % 5.0 == 0.0 && (once - whole).abs() < 1e-4).then_some(whole)
}

/// The number of radians of a text, `"90 rad"`, if it is more than a turn and whole: degrees, most likely.
fn many_radians(written: &str) -> Option<f64> {
    let (number, unit) = quantity::split(written.trim_matches(['"', '\'']))?;
    let value = number.parse::<f64>().ok()?;
    (unit == "rad" && value.abs() > 4.0 * FRAC_PI_2 && value.fract() == 0.0).then_some(value)
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
        let twelfths = |text: &str| twelfths(text.parse().unwrap(), text);
        assert_eq!(["0.7854", "1.0472", "-0.5236", "2.35619449"].map(twelfths), [45, 60, -30, 135].map(Some));
        assert_eq!(["0.785", "0.7860", "45.0000", "0.0000", "5"].map(twelfths), [None; 5]);
        assert_eq!([5156.62015, 2578.310, 5000.0, 90.0].map(converted_twice), [Some(90.0), Some(45.0), None, None]);
        assert_eq!(["\"90 rad\"", "\"1.5 rad\"", "\"90 deg\"", "90"].map(many_radians), [Some(90.0), None, None, None]);
    }
}
