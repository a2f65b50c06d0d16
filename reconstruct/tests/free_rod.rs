//! A recording of a rod that touches nothing.

use crate::common::noise::Noise;
use rod_core::{Pose, Reactions, Rod, Sample};
use rod_reconstruct::{Settings, Source, reconstruct};

#[test]
fn a_free_rod_tells_bias_and_nothing_else() {
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
    let mut noise: [Noise; 3] = std::array::from_fn(|c| Noise::new(c as u64, 0.45));
    let mut next = |c: usize| noise[c].sample();
    let samples: Vec<Sample> = (0..12_000_u32)
        .map(|k| {
            let reactions =
                Reactions { f0x: 1e-3 + 2.5e-3 * next(0), f0y: -1e-3 + 2.5e-3 * next(1), m0z: 2e-5 + 6e-5 * next(2) };
            Sample::new(Pose { x: -2e-6 * f64::from(k), y: -0.04, phi: 1.57 }, reactions)
        })
        .collect();
    let found = reconstruct(&rod, &samples, &Settings::default()).unwrap();
    let calibration = found.calibration().unwrap();
    for (source, bias) in [(Source::BiasF0x, 1e-3), (Source::BiasF0y, -1e-3), (Source::BiasM0z, 2e-5)] {
        let estimate = calibration.source(source).unwrap();
        let off = (estimate.value - bias).abs();
        assert!(off < 4.0 * estimate.sigma && estimate.sigma < 0.5 * estimate.budget, "{estimate:?}");
    }
    // before, a stiffer rod made the noise in its units smaller
    for estimate in calibration.sources.iter().filter(|estimate| !estimate.source.is_of_scan()) {
        let off = estimate.off();
        assert!(off < 1e-6 && (estimate.sigma / estimate.budget - 1.0).abs() < 1e-6, "{estimate:?}");
    }
}
