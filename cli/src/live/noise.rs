//! The noise of a sensor, from what it says of the free rod.

use super::head::{Chain, FEWEST, Scaled};
use super::{LiveError, LiveScan};
use crate::{Error, SensorCalibration};
use vibrissa::hw::{Calibration, Channels, Mounting, RawSample, ReactionSample, Scale, Wrench, WrenchSample};
use vibrissa::reconstruct::Travel;
use vibrissa::reconstruct::noise_estimate::{ChannelNoise, estimate};

/// So many samples from one step of a rounded signal to the next, about.
const STEP: f64 = 64.0;

/// Noise of the reactions of the free rod, no less than the rounding of the sensor's numbers, and the way from sample to sample.
pub(super) fn noise(
    scan: &LiveScan,
    samples: &[ReactionSample],
    chain: &Chain<'_>,
) -> Result<([ChannelNoise; 3], f64), Error> {
    let mut travel = Travel::new(&scan.rod);
    let mut rows: Vec<(f64, [f64; 3])> = Vec::with_capacity(samples.len());
    for sample in samples.iter().filter(|sample| sample.quality.is_usable()) {
        if let Ok(way) = travel.go(&sample.pose) {
            rows.push((way, [sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z]));
        }
    }
    if rows.len() < FEWEST {
        let first = "; the clamp does not move".to_owned();
        return Err(LiveError::TooFew { samples: rows.len(), fewest: FEWEST, first }.into());
    }
    let tau: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let spacing = tau.last().copied().unwrap_or_default() / (tau.len() - 1) as f64;
    let rounding = rounding(chain.calibration(), &scan.setup.mounting, &samples[0]);
    let noise = [0, 1, 2].map(|c| {
        let channel: Vec<f64> = rows.iter().map(|row| row.1[c]).collect();
        let found = estimate(&tau, &channel);
        if found.sigma > rounding[c] {
            return found;
        }
        // without noise to blur it, rounding is off by the same for as many samples as the signal takes from step to step
        ChannelNoise { sigma: rounding[c], lag1: 1.0 - 1.0 / STEP, long_run: STEP }
    });
    Ok((noise, spacing))
}

/// Standard deviation of numbers rounded to one unit of the device: q / sqrt 12.
fn rounding(scaled: &Scaled<'_>, mounting: &Mounting, at: &ReactionSample) -> [f64; 3] {
    // the converter behind gauges is not known
    let SensorCalibration::Scale(scale) = &scaled.calibration else { return [0.0; 3] };
    let one = RawSample::new(0.0, scale.channels(&Wrench::default()));
    let ones = one.channels.iter().map(|_| 1.0).collect::<Vec<f64>>();
    let raw = Channels::new(&ones).map(|channels| RawSample { channels, ..one });
    let quantum = raw.and_then(|raw| scale.wrench(&raw).ok()).map(|sample| sample.wrench).unwrap_or_default();
    // sensors that send N and N m as floats have no unit to round to
    let is_si = *scale == Scale::si();
    let sigma = quantum * if is_si { 0.0 } else { 12.0_f64.sqrt().recip() };
    let sample = WrenchSample { sigma: Some(sigma), ..WrenchSample::new(0.0, Wrench::default()) };
    mounting.reactions(&sample, at.pose).sigma.map_or([0.0; 3], |sigma| [sigma.f0x, sigma.f0y, sigma.m0z])
}
