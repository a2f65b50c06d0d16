//! Random and systematic errors of a calibrated sensor.

use super::{CalibrationDataError, RatedLoad};
use crate::sample::{Component, Number, Wrench, WrenchSample};

/// Errors of a sensor: the standard deviation of the random error, and bounds of the systematic error,
/// which averaging does not make smaller.
///
/// ```
/// use rod_hw::{Accuracy, RatedLoad, Wrench, WrenchSample, WrenchUnits};
/// // class 0.5 of +-2 N, class 0.1 of +-50 mN m
/// let rated = RatedLoad::<f64>::in_units([2.0, 2.0, 2.0, 0.05, 0.05, 0.05], WrenchUnits::SI)?;
/// let percent = Wrench { force: [0.5; 3], torque: [0.1; 3] };
/// let sigma = Wrench { force: [1e-3; 3], torque: [2e-5; 3] };
/// let accuracy = Accuracy::of_class(&rated, percent)?.with_sigma(sigma)?;
/// let sample = accuracy.fill(&WrenchSample::new(0.0, Wrench::default()));
/// assert_eq!(sample.systematic.map(|bound| bound.force[0]), Some(0.01)); // N
/// assert_eq!(sample.sigma, Some(sigma));
/// # Ok::<(), rod_hw::CalibrationDataError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy<T = f64> {
    sigma: Option<Wrench<T>>,
    bound: Wrench<T>,
}

impl<T: Number> Accuracy<T> {
    /// Bounds of the systematic error, N and N m.
    ///
    /// # Errors
    /// [`CalibrationDataError::OfComponent`] where one is negative or not finite.
    pub fn new(bound: Wrench<T>) -> Result<Self, CalibrationDataError> {
        not_negative("the bound of the systematic error", &bound)?;
        Ok(Self { sigma: None, bound })
    }

    /// The maker's accuracy class: percent of the rated load for each component. A component that is not measured may be
    /// without rating, of class 0.
    ///
    /// # Errors
    /// [`CalibrationDataError::OfComponent`] where a class is negative or above 100, or is one of a component that has no
    /// rating.
    pub fn of_class(rated: &RatedLoad<T>, percent: Wrench<T>) -> Result<Self, CalibrationDataError> {
        let largest = rated.largest();
        for component in Component::ALL {
            let value = component.of(&percent).to_f64();
            if !(0.0..=100.0).contains(&value) {
                let expected = "percent of the rated load, from 0 to 100";
                return Err(CalibrationDataError::OfComponent { field: "the class", component, value, expected });
            }
            let value = component.of(&largest).to_f64();
            if component.of(&percent).to_f64() > 0.0 && value.is_infinite() {
                let expected = "a number, to take percents of";
                return Err(CalibrationDataError::OfComponent { field: "the rated load", component, value, expected });
            }
        }
        let zero = T::from_f64(0.0);
        let share = |p: T, load: T| if p == zero { zero } else { load * p * T::from_f64(0.01) };
        Self::new(percent.zip(&largest, share))
    }

    /// The same with standard deviations of the random error, N and N m.
    ///
    /// # Errors
    /// [`CalibrationDataError::OfComponent`] where one is negative or not finite.
    pub fn with_sigma(self, sigma: Wrench<T>) -> Result<Self, CalibrationDataError> {
        not_negative("the standard deviation", &sigma)?;
        Ok(Self { sigma: Some(sigma), ..self })
    }

    /// Bounds of the systematic error, N and N m.
    pub fn systematic(&self) -> Wrench<T> {
        self.bound
    }

    /// The sample with its standard deviations and bounds. Where it has some already, the larger ones count.
    #[must_use]
    pub fn fill(&self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        let larger = |one: Option<Wrench<T>>, other: Option<Wrench<T>>| match (one, other) {
            (Some(one), Some(other)) => Some(one.zip(&other, |a, b| if a > b { a } else { b })),
            (one, other) => one.or(other),
        };
        WrenchSample {
            sigma: larger(sample.sigma, self.sigma),
            systematic: larger(sample.systematic, Some(self.bound)),
            ..*sample
        }
    }
}

fn not_negative<T: Number>(field: &'static str, wrench: &Wrench<T>) -> Result<(), CalibrationDataError> {
    for component in Component::ALL {
        let value = component.of(wrench).to_f64();
        if !(value.is_finite() && value >= 0.0) {
            let expected = "a finite number, not negative";
            return Err(CalibrationDataError::OfComponent { field, component, value, expected });
        }
    }
    Ok(())
}
