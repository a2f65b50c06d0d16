//! What explains a recording that does not fit, and how likely.

use super::calibrated::Calibrated;
use super::settings::Settings;
use crate::check::{Finding, Mistake, plausibility_with_friction};
use crate::friction::{ANY, Friction};
use crate::scan::noise_estimate::{ChannelNoise, estimate};
use crate::scan::passes;
use crate::systematic::{Budget, Calibration, Source, SourceCandidate, candidates};
use rod_core::{Rod, Sample, Uniform};
use std::fmt;

/// Most samples that the likelihood of a mistake is first found from. Fewer: the likeliest ones may be missed; more: more time.
const FIRST: usize = 150;
/// So many of the mistakes that are likeliest by these are looked at again.
const KEPT: usize = 3;
/// Most samples that the likelihoods are found from then, and most of them that are checked by the physics. More: more time.
const MOST_SAMPLES: usize = 600;
const MOST_CHECKED: usize = 300;

/// Smallest noise that is assumed, in parts of the largest reaction. Smaller: of exact samples the errors of thinned ones decide.
const LEAST_NOISE: f64 = 1e-3;

/// Logarithm of the factor by which a source must be more likely than bias and drift alone: strong evidence (Jeffreys 1961, appendix B).
/// Smaller: where bias and drift explain everything, all sources that are as known are told, too.
const STRONG: f64 = 3.0;

/// What explains a recording. Displays in words, without a likelihood.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Explanation {
    /// A mistake in signs, axes, units or the rod.
    Mistake(Mistake),
    /// Bias and drift of the sensor alone.
    Tare,
    /// One source of error besides bias and drift; its value in the unit of the source.
    Source(Source, f64),
    /// Several sources of errors at once.
    Several,
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mistake(mistake) => mistake.fmt(f),
            Self::Tare => f.write_str("bias and drift of the sensor alone"),
            Self::Several => f.write_str("several errors at once"),
            Self::Source(source, value) => {
                let unit = source.name().1;
                if *source == Source::Friction {
                    return write!(f, "friction with mu = {:.2}", value.abs());
                }
                let number = matches!(source, Source::NaturalCurvature | Source::ClampCompliance);
                match unit {
                    "" if number => write!(f, "{source} {value:+.1e}"),
                    "" => write!(f, "{source} {:+.1} %", 100.0 * value),
                    _ => write!(f, "{source} {value:+.1e} {unit}"),
                }
            }
        }
    }
}

/// What explains a recording, the most likely first, with likelihoods that add up to 1: mistakes in signs, axes and units, another
/// bending stiffness or gain where the check by the physics `finds` one, and each source of error that has a budget, on top of bias and drift. Equally
/// likely before the recording is seen.
///
/// For each mistake the likelihood is that of the best labels and errors of the recording without it. That of the recording as it is
/// divides among the sources in proportion to their evidence by Laplace's method, to second order about the estimate with all sources
/// free; sources that are not at least 20 times as likely as bias and drift alone are left out. At most 600 samples are looked at, and of
/// the mistakes only the three that are likeliest by 150. Two mistakes at once, and errors that are not in the budget, are not tried. Empty where
/// nothing that is tried gives a possible recording.
pub fn explanations(rod: &Rod, samples: &[Sample], settings: &Settings, finds: &[Finding]) -> Vec<(Explanation, f64)> {
    let usual = settings.budget.filter(|budget| !budget.is_none()).unwrap_or_else(|| Budget::laboratory(rod));
    let settings = Settings { budget: Some(usual), ..*settings };
    let thin = thinned(samples, MOST_SAMPLES);
    let of_slope = finds.iter().flat_map(|finding| match finding {
        Finding::Stiffness { given, suggested, .. } => Mistake::of_slope(*given, *suggested).to_vec(),
        _ => Vec::new(),
    });
    let log = |mistake: Mistake, samples: &[Sample]| {
        let (rod, undone) = mistake.undone(rod, samples);
        Some((mistake, interpreted(&rod, &undone, &settings)?.log_likelihood))
    };
    // K / (2 |F|) along tangential contacts has one value, that of friction, only in the units in which it was found
    let rubs = finds.iter().any(|finding| matches!(finding, Finding::Friction { .. } | Finding::FrictionGiven { .. }));
    let slope = plausibility_with_friction(rod, samples, |_| 0.0).line.map(|line| line.slope);
    let untared = Mistake::of_rest(samples).filter(|mistake| mistake.is_beyond(usual.bias));
    let is_possible = |mistake: &Mistake| {
        mistake.is_possible(rod, &thin)
            && mistake.leaves_line(rod, slope)
            && !(rubs && matches!(mistake, Mistake::Units(..)))
    };
    let possible = Mistake::ALL.into_iter().chain(untared).chain(of_slope).filter(is_possible);
    let few = thinned(samples, FIRST);
    let mut likely: Vec<(Mistake, f64)> = possible.filter_map(|mistake| log(mistake, &few)).collect();
    likely.sort_by(|a, b| b.1.total_cmp(&a.1));
    let again = likely.into_iter().take(KEPT).filter_map(|(mistake, _)| log(mistake, &thin));
    let mut found: Vec<(Explanation, f64)> = again.map(|(mistake, log)| (Explanation::Mistake(mistake), log)).collect();
    // as it is, whatever its line: that of a recording with few tangential contacts or much noise may be anything
    if let Some((calibration, ..)) = of_longest(rod, &thin, &settings) {
        let mut parts = candidates(&calibration);
        let tare = parts.iter().find(|part| part.0 == SourceCandidate::Tare).map(|part| part.1);
        parts.retain(|part| part.0 == SourceCandidate::Tare || tare.is_none_or(|tare| part.1 > tare + STRONG));
        let all = log_sum(parts.iter().map(|part| part.1));
        found.extend(parts.into_iter().map(|(candidate, log)| {
            let explanation = match candidate {
                SourceCandidate::Tare => Explanation::Tare,
                SourceCandidate::One(source, value) => Explanation::Source(source, value),
                SourceCandidate::Several => Explanation::Several,
            };
            (explanation, calibration.log_likelihood + log - all)
        }));
    }
    let given = finds.iter().any(|finding| matches!(finding, Finding::FrictionGiven { .. }));
    if settings.friction == Friction::None || given {
        found.extend(of_friction(
            rod,
            &thin,
            &settings,
            found.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max),
        ));
    }
    let all = log_sum(found.iter().map(|one| one.1));
    found.iter_mut().for_each(|one| one.1 = (one.1 - all).exp());
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// Friction that was not asked for, or another one than that given, if it explains more than the best of the others; the likelihood contains that nothing was known of the
/// coefficient before.
fn of_friction(rod: &Rod, samples: &[Sample], settings: &Settings, best: f64) -> Option<(Explanation, f64)> {
    let settings = Settings { friction: Friction::Estimate, ..*settings };
    let calibration = interpreted(rod, samples, &settings)?;
    let found = calibration.source(Source::Friction)?;
    let log = calibration.log_likelihood + (found.sigma / ANY).min(1.0).ln();
    (log > best + STRONG).then_some((Explanation::Source(Source::Friction, found.value), log))
}

/// At most so many of the samples, evenly spaced.
fn thinned(samples: &[Sample], most: usize) -> Vec<Sample> {
    samples.iter().step_by(samples.len().div_ceil(most).max(1)).copied().collect()
}

/// What the longest pass of a recording says of the errors that its samples share; none where the line of tangential contacts has units or signs
/// that are impossible, with the errors and without.
fn interpreted(rod: &Rod, samples: &[Sample], settings: &Settings) -> Option<Calibration> {
    let (calibration, part, friction) = of_longest(rod, samples, settings)?;
    let is_gross = |rod: &Rod, samples: &[Sample]| {
        let check = plausibility_with_friction(rod, &thinned(samples, MOST_CHECKED), |_| friction);
        check.findings.iter().any(Finding::is_gross)
    };
    // a bias may look like a wrong sign
    let is_possible = !is_gross(rod, samples)
        || calibration.is_applied() && !is_gross(&calibration.rod(rod), &calibration.corrected(rod, part));
    is_possible.then_some(calibration)
}

/// What the longest pass of a recording says of the errors that its samples share, its samples, and their friction.
fn of_longest<'a>(rod: &Rod, samples: &'a [Sample], settings: &Settings) -> Option<(Calibration, &'a [Sample], f64)> {
    let longest = passes(rod, samples).into_iter().max_by_key(|pass| pass.len())?;
    let part = samples.get(longest)?;
    let settings = Settings { noise: Some(noise(part, settings)), ..*settings };
    let scan = Calibrated::measured(&Uniform, rod, part, &settings).ok()?;
    let rubs = settings.friction != Friction::None;
    let scan = if rubs { scan.rough(&Uniform, rod, &settings) } else { scan.smooth(&Uniform, rod, &settings) };
    let (track, calibration) = scan.ok().map(|scan| (scan.track, scan.calibration))?;
    let calibration = calibration?.1;
    calibration.log_likelihood.is_finite().then_some((calibration, part, track.friction))
}

/// The noise of the channels, at least [`LEAST_NOISE`].
fn noise(samples: &[Sample], settings: &Settings) -> [ChannelNoise; 3] {
    let channels: [fn(&Sample) -> f64; 3] = [|s| s.reactions.f0x, |s| s.reactions.f0y, |s| s.reactions.m0z];
    std::array::from_fn(|c| {
        let usable = samples.iter().map(channels[c]).filter(|value| value.is_finite());
        let (numbers, values): (Vec<f64>, Vec<f64>) = usable.enumerate().map(|(k, value)| (k as f64, value)).unzip();
        let found = settings.noise.map_or_else(|| estimate(&numbers, &values), |given| given[c]);
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        ChannelNoise { sigma: found.sigma.max(LEAST_NOISE * largest), ..found }
    })
}

/// Logarithm of a sum of exponentials.
fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    most + logs.map(|log| (log - most).exp()).sum::<f64>().ln()
}
