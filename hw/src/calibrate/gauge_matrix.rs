//! Gauges to a wrench, by a matrix; their compensation for temperature.

use super::rank::weakest;
use super::wrench_units::{WrenchUnits, finite};
use super::{Calibration, CalibrationDataError, CalibrationError};
use crate::sample::{Channels, Component, Number, RawSample, WrenchSample};
use core::array::from_fn;

/// Less than this part of a row that is not in the other rows is what rounding to the five digits of calibration files
/// leaves of a combination of them.
const INDEPENDENT: f64 = 1e-4;

/// `N` gauges (at most 16) to the components of a wrench: a row each, in force and torque per raw unit.
///
/// ```
/// use rod_hw::{Calibration, Channels, Component, GaugeMatrix, RawSample, WrenchSample, WrenchUnits};
/// // a sensor of three forces and one of a moment on an amplifier with four channels, +-10 V for +-2 N and +-50 mN m
/// let rows = [
///     (Component::Fx, [0.2, 0.0, 0.0, 0.0]),
///     (Component::Fy, [0.0, 0.2, 0.0, 0.0]),
///     (Component::Fz, [0.0, 0.0, 0.2, 0.0]),
///     (Component::Tz, [0.0, 0.0, 0.0, 5.0]),
/// ];
/// let matrix = GaugeMatrix::<4>::new(&rows, WrenchUnits::parse("N", "mN m")?)?.with_bias([0.5, 0.0, 0.0, 0.0])?;
/// let raw = RawSample::new(0.0, Channels::from([1.5, 0.0, 0.0, -2.0]));
/// let sample: WrenchSample = matrix.wrench(&raw)?;
/// assert_eq!((sample.wrench.force[0], sample.wrench.torque[2]), (0.2, -0.01));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugeMatrix<const N: usize, T = f64> {
    /// N and N m per raw unit.
    rows: [[T; N]; 6],
    /// What the gauges read without load.
    bias: [f64; N],
    compensation: Option<Compensation<N>>,
}

impl<const N: usize, T: Number> GaugeMatrix<N, T> {
    /// The rows of the components that the sensor measures, in these units per raw unit. The others are zero.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where an element is not finite, a row is zero or a combination of the others (but for 1e-4
    /// of it), or a component is there twice.
    pub fn new(rows: &[(Component, [f64; N])], units: WrenchUnits) -> Result<Self, CalibrationDataError> {
        const { assert!(N >= 1 && N <= Channels::MOST, "1 to 16 gauges") };
        let (mut si, mut measured) = ([[0.0; N]; 6], [false; 6]);
        for &(component, row) in rows {
            for (gauge, &value) in row.iter().enumerate() {
                if !T::from_f64(value * units.factor(component)).to_f64().is_finite() {
                    return Err(CalibrationDataError::Element { component, gauge: gauge + 1, value });
                }
            }
            if core::mem::replace(&mut measured[component.index()], true) {
                return Err(CalibrationDataError::Twice { component });
            }
            si[component.index()] = row.map(|value| value * units.factor(component));
            if si[component.index()] == [0.0; N] {
                return Err(CalibrationDataError::NoGauge { component });
            }
        }
        if rows.len() > N {
            return Err(CalibrationDataError::Gauges { gauges: N, components: rows.len() });
        }
        let (component, independent) = weakest(&si, measured).ok_or(CalibrationDataError::Nothing)?;
        if independent.is_nan() || independent < INDEPENDENT {
            return Err(CalibrationDataError::Dependent { component, independent, limit: INDEPENDENT });
        }
        Ok(Self { rows: si.map(|row| row.map(T::from_f64)), bias: [0.0; N], compensation: None })
    }

    /// The same with what the gauges read without load, raw.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where one is not finite, or the calibration compensates for temperature: the bias changes with
    /// it, too.
    pub fn with_bias(self, bias: [f64; N]) -> Result<Self, CalibrationDataError> {
        Self { bias, ..self }.settled()
    }

    /// The same, compensated for temperature: without a bias, which is left to the tare. The thermometer is one more channel
    /// after the gauges.
    ///
    /// # Errors
    /// [`CalibrationDataError::BiasTemperature`] where there is a bias.
    pub fn with_compensation(self, compensation: Compensation<N>) -> Result<Self, CalibrationDataError> {
        Self { compensation: Some(compensation), ..self }.settled()
    }

    /// N and N m per raw unit, a row for each component.
    pub fn rows(&self) -> &[[T; N]; 6] {
        &self.rows
    }

    /// With all parts checked beside each other.
    fn settled(self) -> Result<Self, CalibrationDataError> {
        finite("a bias", &self.bias)?;
        if self.compensation.is_some() && self.bias != [0.0; N] {
            return Err(CalibrationDataError::BiasTemperature);
        }
        Ok(self)
    }
}

impl<const N: usize, T: Number> Calibration<T> for GaugeMatrix<N, T> {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        super::expect_channels(raw, N + usize::from(self.compensation.is_some()))?;
        let mut gauges = [0.0; N];
        for (channel, gauge) in gauges.iter_mut().enumerate() {
            *gauge = super::finite_channel(raw, channel)?;
        }
        if let Some(compensation) = &self.compensation {
            gauges = compensation.at_reference(gauges, super::finite_channel(raw, N)?)?;
        }
        // the bias may be much larger than what the load adds to it: it goes before the rounding to T
        let loads: [T; N] = from_fn(|i| T::from_f64(gauges[i] - self.bias[i]));
        let zero = T::from_f64(0.0);
        super::finished(raw, self.rows.map(|row| row.iter().zip(&loads).fold(zero, |sum, (&a, &v)| sum + a * v)))
    }
}

/// How gauges change with temperature: (v + bias_slope (T - T0)) / (1 - gain_slope (T - T0)) is what gauge v would read at
/// T0 (ATI's DAQ F/T library). Slopes are per unit of the thermometer, in raw units and as parts.
///
/// ```
/// use rod_hw::Compensation;
/// let compensation = Compensation::new([0.002, 0.0], [0.0, 0.01], 25.0)?;
/// assert_eq!(compensation.at_reference([1.0, 2.0], 30.0)?, [1.0 + 0.002 * 5.0, 2.0 / 0.95]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation<const N: usize> {
    bias_slopes: [f64; N],
    gain_slopes: [f64; N],
    reference: f64,
}

impl<const N: usize> Compensation<N> {
    /// Of a slope of bias and one of gain for each gauge, and the temperature T0 at which they read as calibrated, in the raw unit
    /// of the thermometer: thermistors are read as volts.
    ///
    /// # Errors
    /// [`CalibrationDataError::Number`] where one is not finite.
    pub fn new(bias_slopes: [f64; N], gain_slopes: [f64; N], reference: f64) -> Result<Self, CalibrationDataError> {
        finite("a slope of bias", &bias_slopes)?;
        finite("a slope of gain", &gain_slopes)?;
        finite("the reference temperature", &[reference])?;
        Ok(Self { bias_slopes, gain_slopes, reference })
    }

    /// What the gauges would read at the reference temperature, in their unit.
    ///
    /// # Errors
    /// [`CalibrationError::Temperature`] where the gain is not positive: the temperature is off, or the slopes are.
    pub fn at_reference(&self, mut gauges: [f64; N], temperature: f64) -> Result<[f64; N], CalibrationError> {
        let above = temperature - self.reference;
        for (i, gauge) in gauges.iter_mut().enumerate() {
            let divisor = 1.0 - self.gain_slopes[i] * above;
            if !(divisor > 0.0 && divisor.is_finite()) {
                return Err(CalibrationError::Temperature { gauge: i + 1, temperature, divisor });
            }
            *gauge = (*gauge + self.bias_slopes[i] * above) / divisor;
        }
        Ok(gauges)
    }
}
