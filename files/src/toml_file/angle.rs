//! Angles in degrees that may be mistakes: those that look like radians, and clamps turned many times.

use super::error::{Fault, visit};
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
    fn right_angles_in_radians() {
        for (text, expected) in [("1.5708", 1), ("-3.142", -2), ("4.712", 3), ("6.283", 4)] {
            assert_eq!(quarters(text.parse().unwrap()), Some(expected), "{text}");
        }
        for degrees in [0.0, 0.0005, 1.5, 1.573, 3.0, 7.854, 90.0, f64::NAN, f64::INFINITY] {
            assert_eq!(quarters(degrees), None, "{degrees}");
        }
    }
}
