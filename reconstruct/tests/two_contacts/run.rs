//! A recording of a scan, with and without noise, and what is reconstructed from it.

use super::scene::Scan;
use crate::common::noise::Noise;
use rod_contact::State;
use rod_core::Reactions;
use rod_reconstruct::{Reading, Sample, Settings, reconstruct};

/// Noise of the sensor.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    pub name: &'static str,
    /// Standard deviations, dimensionless.
    pub force: f64,
    pub moment: f64,
    /// Correlation of neighbouring samples.
    pub correlation: f64,
}

impl Level {
    /// From mN and mN m on a rod of 100 mm and 6.32e-4 N m^2.
    const fn new(name: &'static str, force: f64, moment: f64, correlation: f64) -> Self {
        Self { name, force: force / 63.2, moment: moment / 6.32, correlation }
    }
}

/// No noise.
pub const CLEAN: Level = Level::new("clean", 0.0, 0.0, 0.0);
/// The noise of docs/reconstruction.md; 2.5 mN and 0.06 mN m are the sensors of Merker et al. (2020).
pub const LEVELS: [Level; 7] = [
    CLEAN,
    Level::new("0.2 mN white", 0.2, 0.02, 0.0),
    Level::new("0.2 mN AR(1)", 0.2, 0.02, 0.45),
    Level::new("2.5 mN white", 2.5, 0.06, 0.0),
    Level::new("2.5 mN AR(1)", 2.5, 0.06, 0.45),
    Level::new("10 mN white", 10.0, 0.5, 0.0),
    Level::new("10 mN AR(1)", 10.0, 0.5, 0.45),
];

/// The answers to a recording with this noise.
pub fn readings(scan: &Scan, level: &Level, seed: u64, settings: &Settings) -> Vec<Reading> {
    let samples = samples(&scan.states, level, seed);
    reconstruct(&scan.rod, &samples, settings).map(|found| found.readings).unwrap_or_default()
}

/// A recording of these states with this noise.
pub fn samples(states: &[State], level: &Level, seed: u64) -> Vec<Sample> {
    let mut channels = [0, 1, 2].map(|c| Noise::new(3 * seed + c, level.correlation));
    states
        .iter()
        .map(|state| {
            let Reactions { f0x: x, f0y: y, m0z: m } = state.reactions;
            let [a, b, c] = channels.each_mut().map(|channel| channel.sample());
            let reactions = Reactions { f0x: x + level.force * a, f0y: y + level.force * b, m0z: m + level.moment * c };
            Sample::new(state.pose, reactions)
        })
        .collect()
}
