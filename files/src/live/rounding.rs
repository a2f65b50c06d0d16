//! Rounding in a sensor.

use super::head::Scaled;
use crate::SensorCalibration;
use vibrissa::hw::{Calibration, Channels, Mounting, RawSample, ReactionSample, Scale, Wrench, WrenchSample};
use vibrissa::rod::Reactions;

/// Standard deviation of reactions from numbers rounded to one unit of the device, q / sqrt 12; zero where the unit is not known.
pub(super) fn rounding(scaled: &Scaled<'_>, mounting: &Mounting, at: &ReactionSample) -> Reactions {
    // the converter behind gauges is not known
    let SensorCalibration::Scale(scale) = &scaled.calibration else { return Reactions::default() };
    let one = RawSample::new(0.0, scale.channels(&Wrench::default()));
    let ones = one.channels.iter().map(|_| 1.0).collect::<Vec<f64>>();
    let raw = Channels::new(&ones).map(|channels| RawSample { channels, ..one });
    let quantum = raw.and_then(|raw| scale.wrench(&raw).ok()).map(|sample| sample.wrench).unwrap_or_default();
    // sensors that send N and N m as floats have no unit to round to
    let is_si = *scale == Scale::si();
    let sigma = quantum * if is_si { 0.0 } else { 12.0_f64.sqrt().recip() };
    let sample = WrenchSample { sigma: Some(sigma), ..WrenchSample::new(0.0, Wrench::default()) };
    mounting.reactions(&sample, at.pose).sigma.unwrap_or_default()
}
