//! A recording of a scan, with and without noise, and what is reconstructed from it.

use super::scene::Scan;
use crate::common::noise::Noise;
use rod_core::Reactions;
use rod_reconstruct::{Reading, Sample, Settings, reconstruct};

/// Noise of the sensors of Merker et al. (2020) on a rod of 100 mm and 6.32e-4 N m^2: 2.5 mN and 0.06 mN m, dimensionless.
const FORCE: f64 = 2.5 / 63.2;
const MOMENT: f64 = 0.06 / 6.32;
const CORRELATION: f64 = 0.45;

/// Levels of noise: none, a tenth, and all of it.
pub const LEVELS: [(&str, f64); 3] = [("clean", 0.0), ("tenth", 0.1), ("sensors", 1.0)];

/// The answers to a recording with noise of this level.
pub fn readings(scan: &Scan, level: f64, seed: u64) -> Vec<Reading> {
    let mut channels = [0, 1, 2].map(|c| Noise::new(3 * seed + c, CORRELATION));
    let samples: Vec<Sample> = scan
        .states
        .iter()
        .map(|state| {
            let [f0x, f0y, m0z] = [FORCE, FORCE, MOMENT].map(|sigma| level * sigma);
            let Reactions { f0x: x, f0y: y, m0z: m } = state.reactions;
            let [a, b, c] = channels.each_mut().map(|channel| channel.sample());
            Sample::new(state.pose, Reactions { f0x: x + f0x * a, f0y: y + f0y * b, m0z: m + m0z * c })
        })
        .collect();
    reconstruct(&scan.rod, &samples, &Settings::default()).map(|found| found.readings).unwrap_or_default()
}
