//! The rated load of a sensor.

use super::CalibrationDataError;
use super::wrench_units::WrenchUnits;
use crate::sample::{Component, Number, Quality, Wrench, WrenchSample};

/// The largest size of each component that the sensor is rated for; infinite where it has no rating.
///
/// ```
/// use rod_hw::{Quality, RatedLoad, Wrench, WrenchSample, WrenchUnits};
/// let rated = RatedLoad::<f64>::in_units([2.0, 2.0, 2.0, f64::INFINITY, f64::INFINITY, 50.0], WrenchUnits::parse("N", "mN m")?)?;
/// assert_eq!(rated.largest().torque[2], 0.05);
/// let sample = WrenchSample::new(0.0, Wrench { force: [0.0, -2.1, 0.0], torque: [0.0; 3] });
/// assert_eq!(rated.flag(&sample).quality, Quality::SATURATED);
/// # Ok::<(), rod_hw::CalibrationDataError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatedLoad<T = f64> {
    largest: Wrench<T>,
}

impl<T: Number> RatedLoad<T> {
    /// The largest sizes, N and N m.
    ///
    /// # Errors
    /// [`CalibrationDataError::OfComponent`] where one is not positive.
    pub fn new(largest: Wrench<T>) -> Result<Self, CalibrationDataError> {
        for component in Component::ALL {
            let value = component.of(&largest).to_f64();
            if value.is_nan() || value <= 0.0 {
                let expected = "a positive number, or infinity where there is no rating";
                return Err(CalibrationDataError::OfComponent { field: "the rated load", component, value, expected });
            }
        }
        Ok(Self { largest })
    }

    /// The largest Fx, Fy, Fz, Tx, Ty, Tz in these units.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn in_units(largest: [f64; 6], units: WrenchUnits) -> Result<Self, CalibrationDataError> {
        let si = Component::ALL.map(|c| T::from_f64(units.factor(c) * largest[c.index()]));
        Self::new(Wrench::from_components(si))
    }

    /// The largest sizes, N and N m.
    pub fn largest(&self) -> Wrench<T> {
        self.largest
    }

    /// The sample, flagged [`Quality::SATURATED`] where a component is beyond its rating: all six, because an overloaded
    /// gauge is part of each of them.
    #[must_use]
    pub fn flag(&self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        let size = |component: Component, wrench: &Wrench<T>| component.of(wrench).to_f64().abs();
        let exceeded = Component::ALL.into_iter().any(|c| size(c, &sample.wrench) > size(c, &self.largest));
        let flag = if exceeded { Quality::SATURATED } else { Quality::empty() };
        WrenchSample { quality: sample.quality | flag, ..*sample }
    }
}
