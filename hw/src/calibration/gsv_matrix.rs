//! The six-axis calibration that a GSV-8 holds.

use super::gauge_matrix::about;
use super::wrench_units::{WrenchUnits, finite, positive};
use super::{CalibrationDataError, GaugeMatrix};
use crate::component::Component;
use crate::unit::{Dimension, Unit, UnitError};
use core::array::from_fn;
use rod_core::Scalar;

/// The six-axis calibration that a GSV-8 holds, as its commands read it. It is for channels in mV/V, not for those that the
/// device has made forces of already.
///
/// ```
/// use rod_hw::{GsvMatrix, WrenchUnits};
/// let mut matrix = [0.0; 36];
/// (0..6).for_each(|i| matrix[7 * i] = 40.0);
/// let stored = GsvMatrix { matrix, norm: 5.0, sensitivity: 2.0, zeros: [0.0; 6], offsets: [0.0; 3], units: WrenchUnits::SI };
/// let metre = rod_hw::Unit::find("m").ok_or("no such unit")?;
/// assert_eq!(stored.calibration::<f64>(metre)?.rows()[0][0], 100.0); // N per mV/V
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GsvMatrix {
    /// Row by row: Fx, Fy, Fz, Mx, My, Mz.
    pub matrix: [f64; 36],
    /// What the amplifier gave at its full input when the matrix was measured, V (5 unless set otherwise; 1 where the
    /// matrix is per mV/V).
    pub norm: f64,
    /// The full input of that amplifier, mV/V (2 unless set otherwise; 1 where the matrix is per mV/V).
    pub sensitivity: f64,
    /// What the channels read without load, mV/V.
    pub zeros: [f64; 6],
    /// From the origin of the matrix to the point that moments are to be about, along the axes of the sensor, in the unit
    /// handed to [`calibration`](Self::calibration).
    pub offsets: [f64; 3],
    /// Units of the matrix, per V or mV/V.
    pub units: WrenchUnits,
}

impl GsvMatrix {
    /// The calibration; forces and moments are matrix norm / sensitivity (u - zeros), then moments M - d x F. The vendor's
    /// own headers have the offsets d in m and in mm: state which.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where norm or sensitivity are not positive, another number is not finite, the unit is none
    /// of length, or the matrix is singular.
    pub fn calibration<T: Scalar>(&self, unit_of_offsets: Unit) -> Result<GaugeMatrix<6, T>, CalibrationDataError> {
        positive("norm", self.norm)?;
        positive("sensitivity", self.sensitivity)?;
        finite("an offset", &self.offsets)?;
        if unit_of_offsets.dimension != Dimension::Length {
            let error = UnitError::Dimension { found: unit_of_offsets, expected: Dimension::Length };
            return Err(CalibrationDataError::Unit { field: "unit of the offsets", error });
        }
        let factors = Component::ALL.map(|c| self.units.factor(c) * self.norm / self.sensitivity);
        let rows = from_fn(|i| from_fn(|j| factors[i] * self.matrix[6 * i + j]));
        let moved = about(rows, self.offsets.map(|d| d * unit_of_offsets.factor));
        GaugeMatrix::of_six(moved, WrenchUnits::SI)?.with_bias(self.zeros)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::Calibration;
    use crate::raw::{Channels, RawSample};

    /// Numbers worked out by hand: 5 / 2 * 40 = 100 N per mV/V, 5 / 2 * 2 = 5 N m per mV/V; the point 20 mm up the z axis.
    #[test]
    fn norm_sensitivity_zeros_and_offsets() {
        let mut matrix = [0.0; 36];
        (0..6).for_each(|i| matrix[7 * i] = if i < 3 { 40.0 } else { 2.0 });
        let units = WrenchUnits::parse("N", "N m").unwrap();
        let zeros = [0.1, 0.0, 0.0, 0.0, 0.0, 0.0];
        let stored = GsvMatrix { matrix, norm: 5.0, sensitivity: 2.0, zeros, offsets: [0.0, 0.0, 20.0], units };
        let raw = RawSample::new(0.0, Channels::from([0.2, 0.3, 0.0, 0.0, 0.0, 0.01]));
        let in_unit = |unit: &str| stored.calibration::<f64>(Unit::find(unit).unwrap());
        let found = in_unit("mm").unwrap().wrench(&raw).unwrap().wrench.components();
        // Fx = 10, Fy = 30 N; Mx + z Fy = 0.6, My - z Fx = -0.2, Mz = 0.05 N m
        for (found, expected) in found.iter().zip([10.0, 30.0, 0.0, 0.6, -0.2, 0.05]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        let error = in_unit("N").unwrap_err().to_string();
        assert!(
            error.starts_with("unit of the offsets: `N` is a unit of force, expected one of length: m, mm"),
            "{error}"
        );
        let bad = GsvMatrix { sensitivity: 0.0, ..stored }.calibration::<f64>(Unit::find("m").unwrap()).unwrap_err();
        assert_eq!(bad.to_string(), "sensitivity is 0, expected a positive, finite number");
    }
}
