//! Compensation of gauges for their temperature.

use super::wrench_units::finite;
use super::{CalibrationDataError, CalibrationError};

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
