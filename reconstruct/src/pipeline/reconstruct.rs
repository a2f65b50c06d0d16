//! The reconstruction of a whole scan.

use super::answers::Answers;
use super::reading::{Reading, Reason};
use super::reconstruction::{Pass, Reconstruction};
use super::settings::{ReconstructError, Settings, positive, possible};
use crate::kink::{Kink, KinkKind, KinkOptions, find_kinks};
use crate::phase::{Break, Label, identify, places};
use crate::scan::noise_estimate::{ChannelNoise, estimate};
use crate::scan::{FEWEST_SAMPLES, Noise, Track, dimensionless, quantum};
use crate::systematic::{Budget, Errors, calibrate};
use rod_core::{Rod, Sample};

/// Steps of the reactions, in EI/L^2 and EI/L, from which on they hide transitions: those of a contact that begins are no larger.
const COARSE: f64 = 0.02;

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
    positive([("false_alarms", settings.false_alarms), ("largest_sigma", settings.largest_sigma)])?;
    let mut units = rod.units();
    let (mut track, numbered) = Track::new(rod, samples);
    if track.len() < FEWEST_SAMPLES {
        return Err(ReconstructError::TooFew { usable: track.len(), samples: samples.len(), fewest: FEWEST_SAMPLES });
    }
    let channels = [0, 1, 2].map(|c| track.clamps.iter().map(|clamp| clamp.reactions[c]).collect::<Vec<f64>>());
    let size = [units.force, units.force, units.moment];
    let found = match settings.noise {
        Some(noise) => dimensionless(&noise, units),
        None => noise_of(&track, &channels, samples, size),
    };
    let [f0x, f0y, m0z] = &channels;
    let options = KinkOptions { false_alarms: settings.false_alarms, ..KinkOptions::default() };
    let kinks = find_kinks(&track.tau, [f0x, f0y, m0z], &found, options);
    let noise = Noise::new(&found);
    let steps = channels.each_ref().map(|channel| quantum(channel).filter(|step| *step > COARSE));
    let breaks: Vec<Break> = kinks
        .iter()
        .map(|kink| Break { index: kink.next, jump: kink.kind == KinkKind::Jump, score: kink.score })
        .collect();
    let mut nodes = places(&track, &noise, &breaks);
    let budget = settings.budget.unwrap_or_else(|| Budget::laboratory(rod));
    possible(&budget, &settings.known)?;
    let mut calibration = None;
    if let Some((correction, shared, told)) = calibrate(rod, &track, &noise, &breaks, &nodes, &budget, &settings.known)
    {
        if let Some(correction) = correction {
            track = correction.track(&track);
            nodes = places(&track, &noise, &breaks);
            units = told.rod(rod).units();
        }
        shared.doubt(&mut nodes);
        shared.judge(&Errors::zeros(), &track, &mut nodes);
        calibration = Some((shared, told));
    }
    let identified = identify(&track, &noise, nodes);
    let shared = calibration.as_ref().map(|calibration| &calibration.0);
    let systematic =
        shared.map_or_else(Vec::new, |shared| shared.points(&track, &noise, &identified.nodes, &identified.labels));
    let answers = Answers {
        track: &track,
        kinks: &kinks,
        noise: &noise,
        identified: &identified,
        units,
        settings,
        shared,
        systematic: &systematic,
    };
    let usable = answers.all(&breaks);

    let mut numbers = Vec::with_capacity(track.len());
    let mut readings = Vec::with_capacity(samples.len());
    for (number, place) in numbered.iter().enumerate() {
        match place {
            Ok(index) => {
                // the samples of a stop share a place
                if numbers.len() == *index {
                    numbers.push(number);
                }
                readings.push(usable[*index]);
            }
            Err(fault) => {
                let label = readings.last().map_or(Label::Free, |before: &Reading| before.label);
                readings.push(Reading::without(label, Reason::Fault(*fault)));
            }
        }
    }
    let runs =
        identified.runs.iter().filter(|run| !run.0.is_empty()).map(|run| (numbers[run.0.start], run.1)).collect();
    let slope = |kink: &Kink, c: usize| if kink.kind == KinkKind::Kink { size[c] / units.length } else { size[c] };
    let in_units = |kink: &Kink| Kink {
        tau: kink.tau * units.length,
        sigma_tau: kink.sigma_tau * units.length,
        next: numbers[kink.next.min(numbers.len() - 1)],
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
        windows: identified.nodes.iter().map(|node| if clean { 1 } else { node.fit.window.len() }).collect(),
        evidence: identified.nodes.into_iter().map(|node| node.evidence).collect(),
        steps: std::array::from_fn(|c| steps[c].map(|step| step * size[c])),
        passes: vec![Pass { samples: 0..samples.len(), calibration: calibration.map(|calibration| calibration.1) }],
    })
}

/// The noise of the samples: the standard deviations of the samples, if they have some, otherwise those of the scan; with the correlation
/// that the scan shows.
fn noise_of(track: &Track, channels: &[Vec<f64>; 3], samples: &[Sample], size: [f64; 3]) -> [ChannelNoise; 3] {
    let told: Option<Vec<_>> = samples.iter().map(|sample| sample.sigma).collect();
    std::array::from_fn(|c| {
        let found = estimate(&track.tau, &channels[c]);
        let told = told.as_ref().filter(|told| !told.is_empty()).map(|told| {
            let squares =
                told.iter().map(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z][c].powi(2)).filter(|v| v.is_finite());
            (squares.sum::<f64>() / told.len() as f64).sqrt() / size[c]
        });
        ChannelNoise { sigma: told.unwrap_or(found.sigma), ..found }
    })
}
