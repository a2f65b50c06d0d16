//! The samples of a scan in order along the path of the clamp.

use super::travel::{Halt, Travel};
use crate::point::Clamp;
use rod_core::{Rod, Sample, Units};

/// Why a sample cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The pose, the reactions or their standard deviations are not finite.
    #[error("a number is not finite")]
    NotFinite,
    /// The scan ends before there are enough samples for a phase.
    #[error("too few samples")]
    TooFew,
    /// The clamp does not move on.
    #[error("{0}")]
    Halt(#[from] Halt),
}

/// A scan, dimensionless: path parameter (strictly increasing), clamp poses and reactions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Track {
    /// Path length of the clamp in the norm of (x, y, phi), rod lengths and radians.
    pub tau: Vec<f64>,
    pub clamps: Vec<Clamp>,
    /// Natural curvature of the rod, which the clamps have, too.
    pub natural: f64,
}

/// Makes samples dimensionless, one by one, and gives each its path parameter.
#[derive(Clone, Debug)]
pub(crate) struct Intake {
    units: Units,
    travel: Travel,
}

impl Intake {
    pub fn new(rod: &Rod) -> Self {
        Self { units: rod.units(), travel: Travel::new(rod) }
    }

    /// The path parameter of the next sample, and the sample itself, dimensionless.
    pub fn take(&mut self, sample: &Sample) -> Result<(f64, Clamp), Fault> {
        let clamp = Clamp::new(self.units, sample.pose, sample.reactions);
        let known = sample.sigma.is_none_or(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z].iter().all(|v| v.is_finite()));
        if !clamp.is_finite() || !known {
            return Err(Fault::NotFinite);
        }
        Ok((self.travel.go(&sample.pose)? / self.units.length, clamp))
    }
}

impl Track {
    /// The usable samples, and for each sample its index among them or why it is left out.
    pub fn new(rod: &Rod, samples: &[Sample]) -> (Self, Vec<Result<usize, Fault>>) {
        let mut intake = Intake::new(rod);
        let mut track =
            Self { tau: Vec::with_capacity(samples.len()), clamps: Vec::with_capacity(samples.len()), natural: 0.0 };
        let places = samples
            .iter()
            .map(|sample| {
                let (tau, clamp) = intake.take(sample)?;
                track.tau.push(tau);
                track.clamps.push(clamp);
                Ok(track.tau.len() - 1)
            })
            .collect();
        (track, places)
    }

    pub fn len(&self) -> usize {
        self.tau.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{Pose, Reactions};

    #[test]
    fn what_stands_still_turns_back_or_is_no_number_is_left_out() {
        let rod = Rod::new(0.1, 1e-3).unwrap();
        let at = |x: f64| Sample::new(Pose { x, y: 0.0, phi: 1.0 }, Reactions::default());
        let samples = [at(0.0), at(-1e-3), at(f64::NAN), at(-1e-3), at(-0.5e-3), at(-2e-3)];
        let (track, places) = Track::new(&rod, &samples);
        let [repeated, back] = [Halt::Repeated, Halt::TurnsBack].map(|halt| Err(Fault::Halt(halt)));
        let faults = [Ok(0), Ok(1), Err(Fault::NotFinite), repeated, back, Ok(2)];
        assert_eq!(places, faults);
        assert!((track.tau[2] - 0.02).abs() < 1e-15 && track.len() == 3);
    }
}
