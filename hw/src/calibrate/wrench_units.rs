//! The units of a wrench.

use super::CalibrationDataError;
use crate::sample::{Component, Dimension, Unit, UnitError};

/// A unit of force and one of torque.
///
/// ```
/// use rod_hw::{Component, WrenchUnits};
/// let units = WrenchUnits::parse("N", "N-mm")?;
/// assert_eq!(units.factor(Component::Tz), 1e-3); // N m each
/// let error = WrenchUnits::parse("N", "mN").unwrap_err().to_string();
/// assert!(error.starts_with("torque unit: `mN` is a unit of force, expected one of torque: N m, mN m"), "{error}");
/// # Ok::<(), rod_hw::CalibrationDataError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchUnits {
    force: Unit,
    torque: Unit,
}

impl WrenchUnits {
    /// N and N m.
    pub const SI: Self = Self {
        force: Unit { name: "N", dimension: Dimension::Force, factor: 1.0 },
        torque: Unit { name: "N m", dimension: Dimension::Torque, factor: 1.0 },
    };

    /// These units.
    ///
    /// # Errors
    /// [`CalibrationDataError::Unit`] where one measures something else, [`CalibrationDataError::Number`] where its factor
    /// is not a positive, finite number.
    pub fn new(force: Unit, torque: Unit) -> Result<Self, CalibrationDataError> {
        checked("force unit", force, Dimension::Force)?;
        checked("torque unit", torque, Dimension::Torque)?;
        Ok(Self { force, torque })
    }

    /// The units of these spellings.
    ///
    /// # Errors
    /// [`CalibrationDataError::Unit`], with the spellings that are accepted.
    pub fn parse(force: &str, torque: &str) -> Result<Self, CalibrationDataError> {
        let unit = |field, text, dimension| {
            Unit::parse(text, dimension).map_err(|error| CalibrationDataError::Unit { field, error })
        };
        let force = unit("force unit", force, Dimension::Force)?;
        Ok(Self { force, torque: unit("torque unit", torque, Dimension::Torque)? })
    }

    /// One unit of a component in SI, N or N m.
    pub fn factor(&self, component: Component) -> f64 {
        if component.dimension() == Dimension::Force { self.force.factor } else { self.torque.factor }
    }
}

fn checked(field: &'static str, unit: Unit, expected: Dimension) -> Result<(), CalibrationDataError> {
    if unit.dimension != expected {
        return Err(CalibrationDataError::Unit { field, error: UnitError::Dimension { found: unit, expected } });
    }
    positive(field, unit.factor)
}

/// Refuses what is not a positive, finite number.
pub(super) fn positive(field: &'static str, value: f64) -> Result<(), CalibrationDataError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(CalibrationDataError::Number { field, value, expected: "a positive, finite number" })
}

/// Refuses what is not finite.
pub(super) fn finite(field: &'static str, values: &[f64]) -> Result<(), CalibrationDataError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(CalibrationDataError::Number { field, value, expected: "a finite number" }),
        None => Ok(()),
    }
}
