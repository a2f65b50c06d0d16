//! A sensor of two forces and a moment: three bridges with some crosstalk, and converters of 24 bits ([`Bridges`](crate::Bridges)).

use nalgebra::Matrix3;
use rod_core::{Pose, Reactions};
use rod_hw::{
    Calibration, CalibrationDataError, CalibrationError, Channels, Component, Frame, GaugeMatrix, Mounting, RawSample,
    WrenchUnits,
};

/// Standard deviations of a force, N, and of the moment, N m.
const SIGMA: [f32; 2] = [2.5e-3, 6e-5];

/// The sensor under the clamp.
pub struct Sensor {
    bridges: GaugeMatrix<3, f32>,
    mounting: Mounting<f32>,
}

impl Sensor {
    /// As its calibration sheet says.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where the sheet makes no sense.
    pub fn new() -> Result<Self, CalibrationDataError> {
        // N and N m per count
        let rows = [
            (Component::Fx, [1.2e-7, 2e-9, -1e-9]),
            (Component::Fy, [-1.5e-9, 1.2e-7, 1e-9]),
            (Component::Tz, [3e-11, -2e-11, 6e-9]),
        ];
        let bridges = GaugeMatrix::new(&rows, WrenchUnits::SI)?.with_bias([12_345.0, -6_789.0, 420.0])?;
        Ok(Self { bridges, mounting: Mounting::new(Frame::same()) })
    }

    /// The reactions of the clamp behind counts of the three converters at `t` (s).
    ///
    /// # Errors
    /// [`CalibrationError`] where counts are none.
    pub fn reactions(&self, t: f64, counts: [i32; 3], pose: Pose<f32>) -> Result<Reactions<f32>, CalibrationError> {
        let raw = RawSample::new(t, Channels::from(counts.map(f64::from)));
        Ok(self.mounting.reactions(&self.bridges.wrench(&raw)?, pose).reactions)
    }

    /// Covariance of the reactions.
    pub fn covariance() -> Matrix3<f32> {
        let [force, moment] = SIGMA.map(|sigma| sigma * sigma);
        Matrix3::new(force, 0.0, 0.0, 0.0, force, 0.0, 0.0, 0.0, moment)
    }
}
