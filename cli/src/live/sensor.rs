//! A sensor that is connected.

use super::feed::Feed;
use crate::SensorCalibration;

/// A sensor that is connected.
pub struct Sensor {
    /// Its samples.
    pub feed: Box<dyn Feed>,
    /// What its numbers are in N and N m; none where they are reactions already.
    pub calibration: Option<SensorCalibration>,
    /// What it is, for the record.
    pub name: String,
}
