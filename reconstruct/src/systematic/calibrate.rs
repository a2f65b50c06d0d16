//! Labels and shared errors of a scan by alternating estimation, and the report of the errors.

use super::alternation::{Alternation, LabelsAndErrors, RAISED, raise};
use super::budget::{Budget, deviations};
use super::calibration::{Calibration, SourceEstimate, ties};
use super::correction::{Correction, Frame};
use super::estimate_errors::{
    ErrorEstimate, LabelledPlace, Prior, SMALL, STEPS, estimate_errors, misfit_of, root_mean_square,
};
use super::free::free_stretches;
use super::known::Known;
use super::remaining::{PLACES, RemainingErrors};
use super::source::{Errors, Joint, SOURCES, Source};
use crate::phase::{Break, CRITERIA, Criterion, Label, Place};
use crate::point::Inverse;
use crate::scan::{Noise, Track};
use nalgebra::{DMatrix, SymmetricEigen, Vector3};
use rod_core::{Rod, Uniform};
use std::ops::Range;

/// [`PLACES`] where the likelihood alone is asked for, up to the last turn. Fewer: the labels of this turn may not be the likeliest.
const FEW_PLACES: usize = 80;
/// Most steps of a turn then: as a rule the errors settle in three.
const FEW_STEPS: usize = 3;
/// Way of the clamp, rod lengths, on which the drift of the budget builds up at least: the length of a scan that goes on is not known.
const WAY: f64 = 1.0;
/// Fall of the sum of squares from which on the estimates are taken off the samples: chance lets it fall by as much as the number of
/// sources, with a standard deviation of 7.
const SIGNIFICANT: f64 = 60.0;
/// Residuals of the free rod's reactions, in standard deviations of the noise, from which on some stretch is not free. Larger than what a
/// sensor that drifts at random leaves.
const UNLIKE: f64 = 100.0;

/// A scan whose labels and shared errors are to be found.
pub(crate) struct CalibrationScan<'a, I> {
    pub inverse: &'a I,
    /// A uniform rod of the same units.
    pub rod: &'a Rod,
    pub track: &'a Track,
    pub noise: &'a Noise,
    pub breaks: &'a [Break],
    pub places: &'a [Place],
}

/// The correction of a scan, if it needs one; the remaining errors; and the report. None without a budget where nothing is known.
pub(crate) fn calibrate<I: Inverse>(
    scan: &CalibrationScan<'_, I>,
    budget: &Budget,
    known: &Known,
) -> Option<(Option<Correction>, RemainingErrors, Calibration)> {
    if budget.is_none() && known.is_nothing() {
        return None;
    }
    let frame = Frame::of(scan.track)?;
    let (prior, free) = scan.prior_and_free_stretches(frame, budget, known);
    let places = thin_places(scan.places, PLACES);
    let (alternation, tare_estimate) = scan.start_with_tare(frame, &prior, &free, &places);
    let LabelsAndErrors { estimate: found, prior, raised, labels, likelihood } =
        alternation.run(&prior, &tare_estimate);
    let last = alternation.labelled_places(&labels);
    let taken = sparsest_correction(scan.inverse, frame, &prior, &found, &last, &alternation.least);
    let free = free.into_iter().filter(|range| are_free(range, &places, &labels)).collect();
    let calibration = Calibration {
        log_likelihood: likelihood,
        ..calibration_report(scan.rod, &prior, &raised, &found, &taken, free)
    };
    let shared = RemainingErrors {
        frame,
        factor: remaining_factor(&found, &taken),
        scatter: found.scatter,
        rates: alternation.rates(),
    };
    let correction = if taken == Errors::zeros() { None } else { Correction::new(frame, &taken) };
    Some((correction, shared, calibration))
}

/// The logarithm of the likelihood alone, from few places up to the last turn. On O1 at q = 0.4 in noise it differs from that of
/// [`calibrate`] by 0.04 without friction, by 1.4 with mu = 0.1 (a gain of 48), and by 121 with mu = 0.3 (a gain of 1,414).
pub(crate) fn log_likelihood<I: Inverse>(scan: &CalibrationScan<'_, I>, budget: &Budget, known: &Known) -> Option<f64> {
    if budget.is_none() && known.is_nothing() {
        return None;
    }
    let frame = Frame::of(scan.track)?;
    let (prior, free) = scan.prior_and_free_stretches(frame, budget, known);
    let [few, all] = [FEW_PLACES, PLACES].map(|most| thin_places(scan.places, most));
    let quick = |places| {
        let (alternation, tare_estimate) = scan.start_with_tare(frame, &prior, &free, places);
        (Alternation { steps: FEW_STEPS, ..alternation }, tare_estimate)
    };
    let (alternation, tare_estimate) = quick(&few);
    Some(quick(&all).0.log_likelihood_after_turn(&prior, &alternation.run(&prior, &tare_estimate)))
}

impl<I: Inverse> CalibrationScan<'_, I> {
    /// The prior of the errors, and the stretches in which the rod is free.
    fn prior_and_free_stretches(&self, frame: Frame, budget: &Budget, known: &Known) -> (Prior, Vec<Range<usize>>) {
        let Self { rod, track, noise, breaks, .. } = *self;
        let means = known.means(rod);
        let prior = Prior { means, sigmas: known.deviations(&deviations(budget, rod), rod) };
        let free = match Correction::new(frame, &means).filter(|_| means != Errors::zeros()) {
            Some(correction) => free_stretches(&correction.track(track), noise, breaks, &prior.sigmas),
            None => free_stretches(track, noise, breaks, &prior.sigmas),
        };
        (prior, free)
    }

    /// The alternating estimation on these places, and its start: the errors by the free stretches.
    fn start_with_tare<'a>(
        &'a self,
        frame: Frame,
        prior: &Prior,
        free: &[Range<usize>],
        places: &'a [Place],
    ) -> (Alternation<'a, I>, ErrorEstimate) {
        let in_free = |place: &Place| free.iter().any(|range| range.contains(&place.index));
        let inside: Vec<Place> = places.iter().filter(|place| in_free(place)).cloned().collect();
        let rod = self.inverse;
        let mut alternation =
            Alternation { rod, frame, track: self.track, places, least: [1.0; CRITERIA], steps: STEPS };
        let tare =
            Alternation { places: &inside, ..alternation }.labelled_places(&vec![(Label::Free, 1.0); inside.len()]);
        let mut tare_estimate = estimate_errors(rod, frame, prior, &prior.means, &tare, &alternation.least, STEPS);
        if tare_estimate.scatter[..3].iter().any(|times| *times > UNLIKE) {
            tare_estimate = estimate_errors(rod, frame, prior, &prior.means, &[], &alternation.least, STEPS);
        } else {
            alternation.least = smallest_scatter(frame, &tare_estimate, &tare);
        }
        (alternation, tare_estimate)
    }
}

/// The errors that are known before the first sample of a live scan, whose places are in `track`, and their uncertainty.
pub(crate) fn errors_before_scan(
    rod: &Rod,
    track: &Track,
    budget: &Budget,
    known: &Known,
) -> Option<(Errors, RemainingErrors)> {
    // the drift of the budget is that of a whole scan
    let frame = Frame::of(track)?.on_way(WAY);
    let factor = Joint::from_diagonal(&known.deviations(&deviations(budget, rod), rod));
    Some((known.means(rod), RemainingErrors { frame, factor, scatter: [1.0; CRITERIA], rates: 1.0 }))
}

/// The same after places whose labels are known; `track` has a sample for each place, and nothing else. The first value is what is to be
/// taken off.
pub(crate) fn calibrate_labelled(
    rod: &Rod,
    track: &Track,
    places: &[Place],
    labels: &[(Label, f64)],
    budget: &Budget,
    known: &Known,
) -> Option<(Errors, RemainingErrors, Calibration)> {
    let frame = Frame::of(track)?.on_way(WAY);
    let means = known.means(rod);
    let mut prior = Prior { means, sigmas: known.deviations(&deviations(budget, rod), rod) };
    let mut alternation = Alternation { rod: &Uniform, frame, track, places, least: [1.0; CRITERIA], steps: STEPS };
    let labelled = alternation.labelled_places(labels);
    let mut found = estimate_errors(&Uniform, frame, &prior, &means, &labelled, &alternation.least, STEPS);
    let free: Vec<LabelledPlace> =
        alternation.labelled_places(labels).into_iter().filter(|place| place.label == Label::Free).collect();
    alternation.least = smallest_scatter(frame, &found, &free);
    let mut raised = [false; SOURCES];
    found = estimate_errors(&Uniform, frame, &prior, &found.errors, &labelled, &alternation.least, STEPS);
    if raise(&mut prior, &found.errors, &mut raised) {
        found = estimate_errors(&Uniform, frame, &prior, &found.errors, &labelled, &alternation.least, STEPS);
    }
    let taken = sparsest_correction(&Uniform, frame, &prior, &found, &labelled, &alternation.least);
    let calibration = calibration_report(rod, &prior, &raised, &found, &taken, Vec::new());
    let (factor, rates) = (remaining_factor(&found, &taken), alternation.rates());
    Some((taken, RemainingErrors { frame, factor, scatter: found.scatter, rates }, calibration))
}

/// The smallest residuals of each criterion to be expected, in standard deviations of the noise: those of the reactions and of their
/// rates where the rod is free. They are more than 1 where the sensor drifts at random.
fn smallest_scatter(frame: Frame, found: &ErrorEstimate, free: &[LabelledPlace]) -> [f64; CRITERIA] {
    let mut least = [1.0; CRITERIA];
    let Some(correction) = Correction::new(frame, &found.errors) else { return least };
    let of_values = found.scatter[..3].iter().fold(1.0, |a: f64, b| a.max(*b));
    let of_rates = (0..3).map(|c| {
        let unit = Vector3::from_fn(|i, _| f64::from(u8::from(i == c)));
        let z = |place: &LabelledPlace| {
            let rate = correction.apply(place.tau, &place.measured.clamp, &place.measured.rate).1;
            rate.reactions[c] / place.measured.variance(&Vector3::zeros(), &unit).sqrt()
        };
        root_mean_square(free.iter().map(z))
    });
    let of_rates = of_rates.fold(1.0, f64::max);
    for (c, least) in least.iter_mut().enumerate().skip(3) {
        let values = [Criterion::K, Criterion::Length, Criterion::LengthByTip].iter().any(|own| *own as usize == c);
        *least = if values { of_values } else { of_rates };
    }
    least
}

/// Whether all places in a stretch are labelled so.
fn are_free(stretch: &Range<usize>, places: &[Place], labels: &[(Label, f64)]) -> bool {
    let mut inside = places.iter().zip(labels).filter(|(place, _)| stretch.contains(&place.index));
    inside.all(|(_, label)| label.0 == Label::Free)
}

/// Every so many of the places, so that at most so many are left, and the first one after each break.
fn thin_places(places: &[Place], most: usize) -> Vec<Place> {
    let stride = places.len().div_ceil(most).max(1);
    let kept = places.iter().enumerate().filter(|(k, place)| k % stride == 0 || place.observation.between.is_some());
    kept.map(|(_, place)| Place { weight: (place.weight * stride as f64).min(1.0), ..place.clone() }).collect()
}

/// The sparsest correction that explains the places: the prior means alone, or tare and drift and then one source after the other, each
/// the one that explains most of the residual.
fn sparsest_correction<I: Inverse>(
    rod: &I,
    frame: Frame,
    prior: &Prior,
    found: &ErrorEstimate,
    places: &[LabelledPlace],
    least: &[f64; CRITERIA],
) -> Errors {
    let Prior { means, sigmas } = prior;
    let with = |errors: &Errors| misfit_of(rod, frame, sigmas, errors, found, places);
    let least_misfit = with(&found.errors);
    let is_enough = |errors: &Errors| with(errors) - least_misfit < SIGNIFICANT;
    if is_enough(means) {
        return *means;
    }
    let free = |of: fn(Source) -> bool| std::array::from_fn(|k| of(Source::ALL[k]) && sigmas[k] > 0.0);
    // friction is known as a plateau tells it, and not exactly
    let mut free: [bool; SOURCES] = if sigmas[Source::Friction as usize] > 0.0 {
        free(|source| source == Source::Friction)
    } else {
        free(Source::is_of_scan)
    };
    loop {
        let only = Errors::from_fn(|k, _| if free[k] { sigmas[k] } else { 0.0 });
        let only = Prior { sigmas: only, ..*prior };
        let taken =
            estimate_errors(rod, frame, &only, &restricted_estimate(found, prior, &free), places, least, STEPS).errors;
        if is_enough(&taken) {
            // estimates are no more accurate than that
            let is_nothing = (0..SOURCES).all(|k| (taken[k] - means[k]).abs() <= SMALL * sigmas[k]);
            return if is_nothing { *means } else { taken };
        }
        let of_scan = |k: usize| Source::ALL[k].is_of_scan() && sigmas[k] > 0.0;
        if (0..SOURCES).any(|k| of_scan(k) && !free[k]) {
            free = std::array::from_fn(|k| free[k] || of_scan(k));
            continue;
        }
        let others = (0..SOURCES).filter(|k| !free[*k] && sigmas[*k] > 0.0);
        let best = others.min_by(|i, j| {
            let residual_by = |k: usize| {
                let mut free = free;
                free[k] = true;
                let left = (found.errors - restricted_estimate(found, prior, &free))
                    .component_div(&sigmas.map(|s| s.max(f64::MIN_POSITIVE)));
                (left.transpose() * found.normal * left).x
            };
            residual_by(*i).total_cmp(&residual_by(*j))
        });
        match best {
            Some(best) => free[best] = true,
            None => return found.errors,
        }
    }
}

/// The estimate where only the free errors differ from the prior means, to first order.
fn restricted_estimate(found: &ErrorEstimate, prior: &Prior, free: &[bool; SOURCES]) -> Errors {
    let Prior { means, sigmas } = prior;
    let known = sigmas.map(|sigma| if sigma > 0.0 { 1.0 / sigma } else { 0.0 });
    let right = found.normal * (found.errors - means).component_mul(&known);
    // rows and columns of the others are those of the identity
    let of = |i: usize, j: usize| if free[i] && free[j] { found.normal[(i, j)] } else { f64::from(u8::from(i == j)) };
    let right = Errors::from_fn(|k, _| if free[k] { right[k] } else { 0.0 });
    let solved = Joint::from_fn(of).cholesky().map_or_else(Errors::zeros, |normal| normal.solve(&right));
    means + solved.component_mul(sigmas)
}

/// A factor of the second moments of the errors about those that are subtracted.
fn remaining_factor(found: &ErrorEstimate, taken: &Errors) -> Joint {
    let remaining = found.errors - taken;
    if remaining == Errors::zeros() {
        return found.factor;
    }
    let covariance = found.factor * found.factor.transpose() + remaining * remaining.transpose();
    let eigen = SymmetricEigen::new(covariance);
    eigen.eigenvectors * Joint::from_diagonal(&eigen.eigenvalues.map(|value| value.max(0.0).sqrt()))
}

/// The report of an estimate, in the units of the sources; `taken` are the subtracted errors.
fn calibration_report(
    rod: &Rod,
    prior: &Prior,
    raised: &[bool; SOURCES],
    found: &ErrorEstimate,
    taken: &Errors,
    free: Vec<Range<usize>>,
) -> Calibration {
    let covariance = found.factor * found.factor.transpose();
    let sigma = |k: usize| covariance[(k, k)].max(0.0).sqrt();
    let Prior { means, sigmas } = prior;
    let reported = |k: &usize| sigmas[*k] > 0.0 || means[*k] != 0.0;
    let numbers: Vec<usize> = (0..SOURCES).filter(reported).collect();
    let units: Vec<f64> = numbers.iter().map(|&k| Source::ALL[k].unit(rod)).collect();
    let sources: Vec<SourceEstimate> = numbers
        .iter()
        .zip(&units)
        .map(|(&k, &unit)| {
            let source = Source::ALL[k];
            let [known, budget, value, sigma] = [means[k], sigmas[k], found.errors[k], sigma(k)].map(|v| v * unit);
            SourceEstimate {
                source,
                known,
                given: if raised[k] { budget / RAISED } else { budget },
                budget,
                value,
                sigma,
                taken: taken[k] * unit,
                raised: raised[k],
            }
        })
        .collect();
    let left = |criterion: Criterion| found.misfit[criterion as usize];
    let covariance = DMatrix::from_fn(numbers.len(), numbers.len(), |i, j| {
        covariance[(numbers[i], numbers[j])] * units[i] * units[j]
    });
    let ties = ties(&sources, &covariance);
    Calibration {
        sources,
        covariance,
        ties,
        free,
        direction: 1.0,
        log_likelihood: 0.0,
        misfit_criterion: left(Criterion::K),
        misfit_length: left(Criterion::Length).max(left(Criterion::LengthByTip)),
        misfit_tangent: left(Criterion::Tangent).max(left(Criterion::TangentByTip)),
    }
}
