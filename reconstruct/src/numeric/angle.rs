//! Angles in one turn.

use std::f64::consts::PI;

/// The same angle (radians) in (-pi, pi].
pub(crate) fn wrap_angle(angle: f64) -> f64 {
    let wrap_angle = (PI - angle).rem_euclid(2.0 * PI);
    PI - wrap_angle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_wrapped() {
        assert_eq!((wrap_angle(PI), wrap_angle(-PI), wrap_angle(0.5)), (PI, PI, 0.5));
        assert!((wrap_angle(3.0 * PI + 0.1) - (0.1 - PI)).abs() < 1e-14);
    }
}
