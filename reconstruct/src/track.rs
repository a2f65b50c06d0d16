//! The samples of a scan in order along the path of the clamp.

use crate::known::Clamp;
use crate::sample::Sample;
use nalgebra::Vector3;
use rod_core::{Rod, Units};

/// Least way of the clamp between two samples, in lengths of the rod (or radians): less is rounding.
const STANDS: f64 = 1e-12;

/// Why a sample is of no use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Pose, reactions or their standard deviations are no finite numbers.
    #[error("a number is not finite")]
    NotFinite,
    /// The clamp is where it was before.
    #[error("the pose is that of the sample before")]
    Repeated,
    /// The clamp moves against its way so far.
    #[error("the pose turns back, expected the clamp to go on along its path")]
    TurnsBack,
}

/// A scan, dimensionless: path parameter (strictly increasing), clamp poses and reactions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Track {
    /// Way of the clamp: root of the sum of squares of its translation and its turning angle.
    pub tau: Vec<f64>,
    pub clamps: Vec<Clamp>,
}

/// Takes samples one by one and tells how far the clamp has come.
#[derive(Clone, Debug)]
pub(crate) struct Odometer {
    units: Units,
    last: Option<Clamp>,
    direction: Vector3<f64>,
    tau: f64,
}

impl Odometer {
    pub fn new(units: Units) -> Self {
        Self { units, last: None, direction: Vector3::zeros(), tau: 0.0 }
    }

    /// The path parameter of the next sample, and the sample itself, dimensionless.
    pub fn advance(&mut self, sample: &Sample) -> Result<(f64, Clamp), Fault> {
        let clamp = Clamp::new(self.units, sample.pose, sample.reactions);
        let known = sample.sigma.is_none_or(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z].iter().all(|v| v.is_finite()));
        if !clamp.is_finite() || !known {
            return Err(Fault::NotFinite);
        }
        if let Some(last) = self.last {
            let step = clamp.pose - last.pose;
            if step.norm() < STANDS {
                return Err(Fault::Repeated);
            }
            if step.dot(&self.direction) < 0.0 {
                return Err(Fault::TurnsBack);
            }
            self.direction = step;
            self.tau += step.norm();
        }
        self.last = Some(clamp);
        Ok((self.tau, clamp))
    }
}

impl Track {
    /// The usable samples, and of each sample its place among them or what is wrong with it.
    pub fn new(rod: &Rod, samples: &[Sample]) -> (Self, Vec<Result<usize, Fault>>) {
        let mut odometer = Odometer::new(rod.units());
        let mut track = Self { tau: Vec::with_capacity(samples.len()), clamps: Vec::with_capacity(samples.len()) };
        let places = samples
            .iter()
            .map(|sample| {
                let (tau, clamp) = odometer.advance(sample)?;
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
        let faults = [Ok(0), Ok(1), Err(Fault::NotFinite), Err(Fault::Repeated), Err(Fault::TurnsBack), Ok(2)];
        assert_eq!(places, faults);
        assert!((track.tau[2] - 0.02).abs() < 1e-15 && track.len() == 3);
    }
}
