//! Angles in one turn.

use std::f64::consts::PI;

/// The same angle (radians) in (-pi, pi].
pub(crate) fn wrapped(angle: f64) -> f64 {
    let wrapped = (PI - angle).rem_euclid(2.0 * PI);
    PI - wrapped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_wrapped() {
        assert_eq!((wrapped(PI), wrapped(-PI), wrapped(0.5)), (PI, PI, 0.5));
        assert!((wrapped(3.0 * PI + 0.1) - (0.1 - PI)).abs() < 1e-14);
    }
}
