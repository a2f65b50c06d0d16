//! Whether a live scan can be of its rod, by the physics.

use vibrissa::reconstruct::{Budget, Calibration, Finding, Known, Plausibility, plausibility, reconstruct_passes};
use vibrissa::{Rod, Sample, Settings};

/// Most samples that are kept for the check.
const MOST: usize = 4000;

/// Samples of a scan, evenly spaced, for a check by the physics at its end.
#[derive(Clone, Debug)]
pub(super) struct Physics {
    samples: Vec<Sample>,
    /// Every so many samples one is kept, and the number of those since the last one.
    stride: usize,
    passed: usize,
}

impl Physics {
    pub fn new() -> Self {
        Self { samples: Vec::with_capacity(MOST), stride: 1, passed: 0 }
    }

    pub fn push(&mut self, sample: Sample) {
        self.passed += 1;
        if self.passed < self.stride {
            return;
        }
        self.passed = 0;
        if self.samples.len() == MOST {
            let mut number = 0;
            self.samples.retain(|_| {
                number += 1;
                number % 2 == 0
            });
            self.stride *= 2;
        }
        self.samples.push(sample);
    }

    /// The misfits in words: of the samples as they are or, where the scan told errors that all of them share, without these.
    pub fn misfits(&self, rod: &Rod, calibration: Option<&Calibration>) -> Vec<String> {
        let mut check = plausibility(rod, &self.samples);
        if let Some(calibration) = calibration.filter(|calibration| !check.fits() && calibration.is_applied()) {
            check = plausibility(&calibration.rod(rod), &calibration.corrected(rod, &self.samples));
        }
        let Plausibility { findings, .. } = check;
        findings.iter().filter(|finding| finding.is_misfit()).map(ToString::to_string).collect()
    }

    /// Friction, which a live scan takes for none, in words; empty where a reconstruction of the samples sees none.
    pub fn friction(&self, rod: &Rod, budget: Budget, known: Known) -> Vec<String> {
        let settings = Settings { budget: Some(budget), known, ..Settings::default() };
        let found =
            reconstruct_passes(rod, &self.samples, &settings).map_or_else(|_| Vec::new(), |found| found.findings());
        let friction = found.iter().filter(|finding| matches!(finding, Finding::Friction { .. }));
        friction.map(|finding| format!("{finding}; live contact points neglect friction and are wrong")).collect()
    }
}
