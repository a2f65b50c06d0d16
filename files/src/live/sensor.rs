//! A sensor that is connected.

use super::feed::Feed;
use crate::SensorCalibration;

/// A sensor that is connected.
pub struct Sensor {
    /// Its samples.
    pub feed: Box<dyn Feed>,
    /// Its calibration to N and N m; none where the samples are reactions already.
    pub calibration: Option<SensorCalibration>,
    /// Its name for the record.
    pub name: String,
}
