//! The reconstruction of a whole scan.

use super::answers::Answers;
use super::calibrated::Calibrated;
use super::reading::{Reading, Reason};
use super::reconstruction::{Pass, Reconstruction, runs};
use super::settings::{ReconstructError, Settings};
use crate::kink::{Kink, KinkKind};
use crate::phase::{Label, identify_phases};
use crate::point::Inverse;
use crate::scan::SampleNumber;
use crate::scan::noise_estimate::ChannelNoise;
use rod_core::{Rod, Sample, Uniform};

/// Computes from the reactions of a scan the phase of each sample and the places where the rod touched the object.
///
/// The samples follow one path of the clamp; [`reconstruct_passes`](crate::reconstruct_passes) splits a recording whose clamp
/// turns back. Samples that are not finite are left out, with the reason, and so are a few that repeat a pose or turn back. Where
/// these are more than 1 % of the samples, the poses are noisy and are smoothed along the path; the samples of a clamp that
/// stands still are averaged.
///
/// Kinks and jumps cut the scan into parts. In each part local cubics give the reactions and their rates with covariance. Criteria
/// computed from these (phase criterion, length, tangent: see [`Evidence`](crate::Evidence)) and the phase diagram of Merker et al. (2020,
/// fig. 8b) give the labels. Single contacts follow in closed form, several from the envelope of the scan.
///
/// Accuracy: on noise-free samples single contact points are exact to 1e-11 of the rod's length. In noise, each has its covariance.
///
/// # Errors
/// [`ReconstructError`].
pub fn reconstruct(rod: &Rod, samples: &[Sample], settings: &Settings) -> Result<Reconstruction, ReconstructError> {
    reconstruct_by(&Uniform, rod, samples, settings)
}

/// [`reconstruct`] by the inverse of a rod; `given` is a uniform rod of the same units.
pub(super) fn reconstruct_by<I: Inverse>(
    rod: &I,
    given: &Rod,
    samples: &[Sample],
    settings: &Settings,
) -> Result<Reconstruction, ReconstructError> {
    let Calibrated { track, indices, found, kinks, noise, steps, breaks, places, units, calibration, friction } =
        Calibrated::of(rod, given, samples, settings)?;
    let phases = identify_phases(rod, &track, &noise, places);
    let shared = calibration.as_ref().map(|calibration| &calibration.0);
    let systematic = shared
        .map_or_else(Vec::new, |shared| shared.point_covariances(rod, &track, &noise, &phases.places, &phases.labels));
    let answers = Answers {
        rod,
        track: &track,
        kinks: &kinks,
        noise: &noise,
        phases: &phases,
        units,
        settings,
        shared,
        systematic: &systematic,
    };
    let usable = answers.all(&breaks);

    // by track index, the first of the samples with this index
    let mut numbers: Vec<SampleNumber> = Vec::with_capacity(track.len());
    let mut readings = Vec::with_capacity(samples.len());
    for (number, index) in indices.iter().enumerate() {
        match index {
            Ok(index) => {
                // the samples of a clamp that stands still share an index
                if numbers.len() == index.0 {
                    numbers.push(SampleNumber(number));
                }
                readings.push(usable[index.0]);
            }
            Err(fault) => {
                // that of the sample before, or of the first one that can be used: a pass may begin in contact
                let beside = readings.last().or(usable.first());
                let label = beside.map_or(Label::Free, |beside: &Reading| beside.label);
                readings.push(Reading::without(label, Reason::Fault(*fault)));
            }
        }
    }
    let runs = runs(numbers.iter().zip(&usable).map(|(number, reading)| (number.0, reading.label)));
    let of_given = given.units();
    let size = [of_given.force, of_given.force, of_given.moment];
    let slope = |kink: &Kink, c: usize| if kink.kind == KinkKind::Kink { size[c] / units.length } else { size[c] };
    let in_units = |kink: &Kink| Kink {
        tau: kink.tau * units.length,
        sigma_tau: kink.sigma_tau * units.length,
        // from a track index to the number of a sample
        next: numbers[kink.next.min(numbers.len() - 1)].0,
        change: std::array::from_fn(|c| kink.change[c] * slope(kink, c)),
        sigma: std::array::from_fn(|c| kink.sigma[c] * slope(kink, c)),
        ..*kink
    };
    let clean = noise.is_clean();
    Ok(Reconstruction {
        readings,
        runs,
        kinks: kinks.iter().map(in_units).collect(),
        noise: std::array::from_fn(|c| ChannelNoise { sigma: found[c].sigma * size[c], ..found[c] }),
        windows: phases.places.iter().map(|place| if clean { 1 } else { place.fit.window.len() }).collect(),
        evidence: phases.places.into_iter().map(|place| place.evidence).collect(),
        steps: std::array::from_fn(|c| steps[c].map(|step| step * size[c])),
        passes: vec![Pass {
            samples: 0..samples.len(),
            calibration: calibration.map(|calibration| calibration.1),
            used_friction: track.friction,
            friction,
        }],
    })
}
