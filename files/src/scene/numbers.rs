//! Checks of numbers that several tables of a scene have: angles and steps.

use crate::toml_file::Fault;
use std::ops::Range;
use vibrissa::contact::LARGEST_ANGLE;

/// Most states a sweep may report: a gigabyte of them, three orders beyond what a figure can show.
pub(crate) const MOST_STATES: f64 = 1e6;

/// What is said of an angle that is not finite.
pub(super) fn not(what: &str, value: f64) -> String {
    format!("{what} is {value}, expected a finite number of degrees")
}

/// What is said of an angle that is too large.
pub(super) fn too_large(what: &str, value: f64) -> String {
    let most = LARGEST_ANGLE.to_degrees().floor();
    format!("{what} is {value} degrees, expected at most {most} degrees either way")
}

/// A step that is one, and of which `length` has not too many.
pub(super) fn check_step_count(span: Range<usize>, what: &str, step: f64, length: f64) -> Result<f64, Fault> {
    if !(step.is_finite() && step > 0.0) {
        return Err(Fault::new(span, format!("{what} is {step}, expected a positive, finite number")));
    }
    let states = length / step;
    if states > MOST_STATES {
        let message =
            format!("{what} is {step:e}, which asks for {states:.1e} states, expected at most {MOST_STATES:e}");
        return Err(Fault::new(span, message));
    }
    Ok(step)
}
