//! Gauges to a wrench, by a matrix; their compensation for temperature.

use super::wrench_units::{WrenchUnits, finite};
use super::{Calibration, CalibrationDataError, CalibrationError};
use crate::sample::{Channels, Component, Number, RawSample, WrenchSample};
use core::array::from_fn;
use rod_core::Scalar;

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
    /// The reading of the gauges without load.
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

    /// The reading of the gauges at the reference temperature, in their unit.
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

/// The row that the others come nearest to giving, and the part of it that they do not give: the sine of the angle between
/// it and them, 0 where it is a combination of them. Rows are scaled to one length first, since N and N m do not compare.
///
/// Gram and Schmidt's method, the row that is left with most taken first, each twice against rounding.
fn weakest<const N: usize>(rows: &[[f64; N]; 6], given: [bool; 6]) -> Option<(Component, f64)> {
    let mut left = *rows;
    let mut waiting = given;
    let mut weakest = None;
    for row in &mut left {
        scale(row);
    }
    loop {
        let norms = left.map(|row| norm(&row));
        let candidates = Component::ALL.into_iter().filter(|c| waiting[c.index()]);
        let Some(next) = candidates.max_by(|a, b| norms[a.index()].total_cmp(&norms[b.index()])) else {
            return weakest;
        };
        weakest = Some((next, norms[next.index()]));
        waiting[next.index()] = false;
        let mut direction = left[next.index()];
        scale(&mut direction);
        for row in left.iter_mut().zip(waiting).filter(|(_, waiting)| *waiting).map(|(row, _)| row) {
            for _ in 0..2 {
                let share: f64 = row.iter().zip(&direction).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(&direction).for_each(|(a, b)| *a -= share * b);
            }
        }
    }
}

fn norm<const N: usize>(row: &[f64; N]) -> f64 {
    Scalar::sqrt(row.iter().map(|a| a * a).sum::<f64>())
}

/// To length 1, by the largest element first, whose square may be out of range.
fn scale<const N: usize>(row: &mut [f64; N]) {
    let largest = row.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    if largest > 0.0 {
        row.iter_mut().for_each(|a| *a /= largest);
        let norm = norm(row);
        row.iter_mut().for_each(|a| *a /= norm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;
    use proptest::prelude::*;

    proptest! {
        /// Beside the singular values of the matrix of rows of length 1: the smallest is no larger than the part, and not
        /// smaller than it by more than the number of rows can make it (pivoted QR).
        #[test]
        fn as_singular_values_have_it(
            elements in proptest::collection::vec(-1.0..1.0_f64, 48),
            mix in proptest::array::uniform5(-1.0..1.0_f64),
            gap in -9.0..0.0_f64,
            size in -200.0..200.0_f64,
        ) {
            let mut rows: [[f64; 8]; 6] = core::array::from_fn(|i| core::array::from_fn(|j| elements[8 * i + j]));
            let gap = 10_f64.powf(gap);
            let others: [f64; 8] = core::array::from_fn(|j| (0..5).map(|i| mix[i] * rows[i][j]).sum());
            rows[5].iter_mut().zip(others).for_each(|(a, others)| *a = others + gap * *a);
            let mut unit = rows;
            unit.iter_mut().for_each(scale);
            let smallest = SMatrix::<f64, 6, 8>::from_fn(|i, j| unit[i][j]).singular_values().min();
            rows[2].iter_mut().for_each(|a| *a *= 10_f64.powf(size));
            let (_, part) = weakest(&rows, [true; 6]).unwrap();
            prop_assert!(smallest <= part * (1.0 + 1e-6) + 1e-14, "{smallest} {part}");
            prop_assert!(part <= 100.0 * smallest + 1e-14, "{smallest} {part}");
        }
    }

    #[test]
    fn a_repeated_row_has_no_part_of_its_own() {
        let mut rows = [[0.0; 6]; 6];
        (0..6).for_each(|i| rows[i][i] = 1.0);
        assert_eq!(weakest(&rows, [true; 6]).unwrap().1, 1.0);
        rows[4] = rows[1].map(|a| 3.0 * a);
        let (component, part) = weakest(&rows, [true; 6]).unwrap();
        assert!(matches!(component, Component::Ty | Component::Fy) && part == 0.0);
        assert_eq!(weakest(&rows, [true, true, true, true, false, true]).unwrap().1, 1.0);
        assert_eq!(weakest(&rows, [false; 6]), None);
    }
}
