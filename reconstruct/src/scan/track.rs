//! The usable samples of a scan, in order along the path of the clamp, and the numbers by which samples are counted.

use super::FEWEST_SAMPLES;
use super::frozen::frozen;
use super::passes::{passes, trembling};
use super::smooth_path::smooth_path;
use super::spikes::spikes;
use super::stops::stops;
use super::travel::{Halt, Travel};
use crate::point::Clamp;
use nalgebra::Vector3;
use rod_core::{Pose, Rod, Sample, Units};

/// Why a sample cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The pose, the reactions or their standard deviations are not finite.
    #[error("a number is not finite")]
    NotFinite,
    /// A reaction stands out of those of the neighbouring samples by far more than the noise.
    #[error("a spike: a reaction differs from its neighbours by more than 10 standard deviations")]
    Spike,
    /// A reaction stays exactly the same, although it is noisy elsewhere: the sensor is lost or at the end of its range.
    #[error("a reaction stays exactly the same for 40 samples or more: the sensor is lost or at the end of its range")]
    Frozen,
    /// The scan ends before there are enough samples for a phase.
    #[error("too few samples")]
    TooFew,
    /// The clamp does not move on.
    #[error("{0}")]
    Halt(#[from] Halt),
}

/// The number of a sample in the slice that a reconstruction is given, from 0, usable or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SampleNumber(pub(crate) usize);

/// The number of a usable sample in a [`Track`], from 0. The samples of a clamp that stands still have one index together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TrackIndex(pub(crate) usize);

/// The usable samples of a scan, dimensionless: path parameter (strictly increasing), clamp poses and reactions. Counted by [`TrackIndex`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Track {
    /// Path length of the clamp in the norm of (x, y, phi), rod lengths and radians.
    pub tau: Vec<f64>,
    pub clamps: Vec<Clamp>,
    /// Natural curvature of the rod, which the clamps have, too.
    pub natural: f64,
    /// Tangent of the angle of friction, which the clamps have, too.
    pub friction: f64,
}

/// Scales samples to dimensionless ones, one by one, and computes the path parameter of each.
#[derive(Clone, Debug)]
pub(crate) struct SampleScaling {
    units: Units,
    travel: Travel,
}

impl SampleScaling {
    pub fn new(rod: &Rod) -> Self {
        Self { units: rod.units(), travel: Travel::new(rod) }
    }

    /// The path parameter of the next sample, and the sample itself, dimensionless.
    pub fn scale(&mut self, sample: &Sample) -> Result<(f64, Clamp), Fault> {
        let clamp = Clamp::new(self.units, sample.pose, sample.reactions);
        let known = sample.sigma.is_none_or(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z].iter().all(|v| v.is_finite()));
        if !clamp.is_finite() || !known {
            return Err(Fault::NotFinite);
        }
        Ok((self.travel.go(&sample.pose)? / self.units.length, clamp))
    }
}

/// Share of the samples that may repeat a pose or turn back. If there are more, the poses are noisy and are smoothed. Larger: more
/// samples of a trembling clamp are left out. Smaller: a few held samples change all poses.
const HALTS: f64 = 0.01;

impl Track {
    /// The usable samples, and for each sample its track index or the reason why the track leaves it out.
    ///
    /// Where poses are exact they are used as they are. Noisy ones are smoothed, and samples of a clamp that stands still are
    /// averaged: then several samples have the same index. A recording of several passes is not smoothed.
    pub fn new(rod: &Rod, samples: &[Sample]) -> (Self, Vec<Result<TrackIndex, Fault>>) {
        let (track, indices) = Self::exact(rod, samples);
        let halts = indices.iter().filter(|index| matches!(index, Err(Fault::Halt(_)))).count();
        if samples.len() < FEWEST_SAMPLES || halts as f64 <= HALTS * samples.len() as f64 {
            return (track, indices);
        }
        if passes(rod, samples).len() > 1 {
            return (track, indices);
        }
        Self::with_smooth_poses(rod, samples, &indices).unwrap_or((track, indices))
    }

    /// The samples whose poses go on in one direction.
    fn exact(rod: &Rod, samples: &[Sample]) -> (Self, Vec<Result<TrackIndex, Fault>>) {
        let mut scaling = SampleScaling::new(rod);
        let mut track = Self {
            tau: Vec::with_capacity(samples.len()),
            clamps: Vec::with_capacity(samples.len()),
            ..Self::default()
        };
        let indices = samples
            .iter()
            .zip(frozen(samples).into_iter().zip(spikes(samples)))
            .map(|(sample, (frozen, spike))| {
                if frozen {
                    return Err(Fault::Frozen);
                }
                if spike {
                    return Err(Fault::Spike);
                }
                let (tau, clamp) = scaling.scale(sample)?;
                track.tau.push(tau);
                track.clamps.push(clamp);
                Ok(TrackIndex(track.tau.len() - 1))
            })
            .collect();
        (track, indices)
    }

    /// All finite samples, with smoothed poses; none where no smoothing lets the clamp go on in one direction.
    fn with_smooth_poses(
        rod: &Rod,
        samples: &[Sample],
        indices: &[Result<TrackIndex, Fault>],
    ) -> Option<(Self, Vec<Result<TrackIndex, Fault>>)> {
        let units = rod.units();
        let usable =
            |index: &Result<TrackIndex, Fault>| !matches!(index, Err(Fault::NotFinite | Fault::Spike | Fault::Frozen));
        let clamps: Vec<Clamp> = samples
            .iter()
            .zip(indices)
            .filter(|(_, index)| usable(index))
            .map(|(sample, _)| Clamp::new(units, sample.pose, sample.reactions))
            .collect();
        let poses: Vec<(usize, [f64; 3])> = clamps.iter().map(|clamp| (0, clamp.pose.into())).collect();
        let stops = stops(&clamps, trembling(&poses));
        let along = |poses: &[Vector3<f64>]| -> Option<Vec<f64>> {
            let mut travel = Travel::new(rod);
            let pose = |p: &Vector3<f64>| Pose { x: p.x * units.length, y: p.y * units.length, phi: p.z };
            poses.iter().map(|p| Some(travel.go(&pose(p)).ok()? / units.length)).collect()
        };
        let own: Vec<Vector3<f64>> = stops.iter().map(|stop| stop.clamp.pose).collect();
        let poses = if along(&own).is_some() { own } else { smooth_path(&own, |poses| along(poses).is_some())? };
        let tau = along(&poses)?;
        let clamps = stops.iter().zip(&poses).map(|(stop, pose)| Clamp { pose: *pose, ..stop.clamp }).collect();
        let mut of_stops =
            stops.iter().enumerate().flat_map(|(k, stop)| std::iter::repeat_n(TrackIndex(k), stop.count));
        let indices = indices
            .iter()
            .map(|index| if usable(index) { of_stops.next().ok_or(Fault::TooFew) } else { *index })
            .collect();
        Some((Self { tau, clamps, ..Self::default() }, indices))
    }

    /// The same with friction whose angle has this tangent.
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self.clamps.iter_mut().for_each(|clamp| clamp.friction = friction);
        self
    }

    pub fn len(&self) -> usize {
        self.tau.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::Reactions;

    #[test]
    fn what_stands_still_turns_back_or_is_no_number_is_left_out() {
        let rod = Rod::new(0.1, 1e-3).unwrap();
        let at = |x: f64| Sample::new(Pose { x, y: 0.0, phi: 1.0 }, Reactions::default());
        let samples = [at(0.0), at(-1e-3), at(f64::NAN), at(-1e-3), at(-0.5e-3), at(-2e-3)];
        let (track, indices) = Track::new(&rod, &samples);
        let [repeated, back] = [Halt::Repeated, Halt::TurnsBack].map(|halt| Err(Fault::Halt(halt)));
        let faults = [Ok(0), Ok(1), Err(Fault::NotFinite), repeated, back, Ok(2)].map(|index| index.map(TrackIndex));
        assert_eq!(indices, faults);
        assert!((track.tau[2] - 0.02).abs() < 1e-15 && track.len() == 3);
    }
}
