//! Angles in degrees that may be mistakes: those that look like radians or were converted twice, and clamps turned many times.

use super::error::{Fault, visit};
use super::quantity;
use std::f64::consts::FRAC_PI_2;
use toml::de::DeTable;

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
