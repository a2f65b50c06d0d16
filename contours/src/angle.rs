//! Angles but for whole turns.

use std::f64::consts::{PI, TAU};

/// The same angle (rad) in the turn in which it is nearest to another one.
pub(crate) fn near(angle: f64, other: f64) -> f64 {
    angle + TAU * ((other - angle) / TAU).round()
}

/// The same angle between -pi and pi, rad.
pub(crate) fn wrapped(angle: f64) -> f64 {
    if angle.abs() <= PI { angle } else { near(angle, 0.0) }
}
