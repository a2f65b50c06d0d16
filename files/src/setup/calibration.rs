//! What makes N and N m of what a sensor sends.

use std::fmt;
use std::sync::Arc;
use vibrissa::hw::{Calibration, CalibrationError, Rails, RawSample, Scale, WrenchSample};

/// What makes N and N m of what a sensor sends.
#[derive(Clone, Debug)]
pub enum SensorCalibration {
    /// A factor for each component.
    Scale(Scale),
    /// A matrix for strain gauges.
    Gauges(Gauges),
}

/// A matrix for strain gauges, whatever their number.
#[derive(Clone)]
pub struct Gauges {
    pub(super) matrix: Arc<dyn Calibration + Send + Sync>,
    /// So many values a sample: those of the gauges, perhaps that of a thermometer.
    pub(super) channels: usize,
    pub(super) rails: Rails,
}

impl Gauges {
    /// How many values a sample has: those of the gauges in order, then perhaps that of a thermometer.
    pub fn channels(&self) -> usize {
        self.channels
    }
}

impl fmt::Debug for Gauges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { channels, rails, .. } = self;
        f.debug_struct("Gauges").field("channels", channels).field("rails", rails).finish_non_exhaustive()
    }
}

impl SensorCalibration {
    /// The ends of the range of the raw values, as far as they are known.
    pub fn rails(&self) -> Rails {
        match self {
            Self::Scale(_) => Rails::none(),
            Self::Gauges(gauges) => gauges.rails,
        }
    }
}

impl Calibration for SensorCalibration {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample, CalibrationError> {
        match self {
            Self::Scale(scale) => scale.wrench(raw),
            Self::Gauges(gauges) => gauges.matrix.wrench(raw),
        }
    }
}
