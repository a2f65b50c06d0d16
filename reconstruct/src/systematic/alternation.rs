//! Alternating estimation: the most likely labels given the shared errors, then the errors given the labels, until both stay the same.

use super::calibration::BEYOND;
use super::correction::Frame;
use super::estimate_errors::{ErrorEstimate, LabelledPlace, Prior, estimate_errors};
use super::remaining::RemainingErrors;
use super::source::{Errors, Joint, SOURCES};
use crate::phase::{CRITERIA, Criterion, Label, Place, label_log_likelihood, most_likely_labels};
use crate::point::Inverse;
use crate::scan::Track;

/// Most turns of labelling and estimating.
const TURNS: usize = 6;
/// Factor by which a budget is raised that an estimate contradicts.
pub(super) const RAISED: f64 = 3.0;

/// The alternating estimation of labels and errors at these places of a scan.
pub(super) struct Alternation<'a, I> {
    pub rod: &'a I,
    pub frame: Frame,
    pub track: &'a Track,
    pub places: &'a [Place],
    /// The smallest residuals of each criterion to be expected, in standard deviations of the noise.
    pub least: [f64; CRITERIA],
    /// Most Gauss-Newton steps of a turn.
    pub steps: usize,
}

/// Labels and errors that agree with each other.
#[derive(Clone)]
pub(super) struct LabelsAndErrors {
    pub estimate: ErrorEstimate,
    pub prior: Prior,
    pub raised: [bool; SOURCES],
    pub labels: Vec<(Label, f64)>,
    /// Log of the likelihood of labels and errors together.
    pub likelihood: f64,
}

/// Raises each budget, once, that an estimate contradicts; whether there are any.
pub(super) fn raise(prior: &mut Prior, errors: &Errors, raised: &mut [bool; SOURCES]) -> bool {
    let mut any = false;
    for (k, raised) in raised.iter_mut().enumerate() {
        let off = (errors[k] - prior.means[k]).abs();
        if !*raised && off > BEYOND * prior.sigmas[k] {
            prior.sigmas[k] *= RAISED;
            (*raised, any) = (true, true);
        }
    }
    any
}

impl<I: Inverse> Alternation<'_, I> {
    /// The likelier result of two starts: the recording as it is, and any recording within the budget. From the second one a scan
    /// with large errors is labelled; with it alone, wrong labels of a good scan might agree with large errors.
    pub fn run(&self, prior: &Prior, tared: &ErrorEstimate) -> LabelsAndErrors {
        let as_is = ErrorEstimate { errors: prior.means, factor: Joint::zeros(), ..tared.clone() };
        let [as_is, any] = [&as_is, tared].map(|start| self.run_from(prior, start));
        if as_is.likelihood >= any.likelihood { as_is } else { any }
    }

    /// Labels and errors from one start; `given` is the prior before any budget is raised.
    fn run_from(&self, given: &Prior, start: &ErrorEstimate) -> LabelsAndErrors {
        let (mut estimate, mut prior, mut raised) = (start.clone(), *given, [false; SOURCES]);
        let mut places = self.places.to_vec();
        self.remaining(&estimate).weaken_breaks(&mut places);
        let mut before: Vec<(Label, f64)> = Vec::new();
        for _ in 0..TURNS {
            self.remaining(&estimate).update_evidence(self.rod, &estimate.errors, self.track, &mut places);
            let now = most_likely_labels(&places, false);
            estimate = estimate_errors(
                self.rod,
                self.frame,
                &prior,
                &estimate.errors,
                &self.labelled_places(&now),
                &self.least,
                self.steps,
            );
            let again = raise(&mut prior, &estimate.errors, &mut raised);
            let same = now.iter().zip(&before).all(|(now, before)| now.0 == before.0) && now.len() == before.len();
            before = now;
            if same && !again {
                break;
            }
        }
        let likelihood = self.log_likelihood(&estimate, given, places);
        LabelsAndErrors { estimate, prior, raised, labels: before, likelihood }
    }

    /// The log-likelihood after one more turn on these places, from labels and errors that were found on others. `given` is the prior.
    pub fn log_likelihood_after_turn(&self, given: &Prior, found: &LabelsAndErrors) -> f64 {
        let mut places = self.places.to_vec();
        let remaining = self.remaining(&found.estimate);
        remaining.weaken_breaks(&mut places);
        remaining.update_evidence(self.rod, &found.estimate.errors, self.track, &mut places);
        let labelled = self.labelled_places(&most_likely_labels(&places, false));
        let estimate = estimate_errors(
            self.rod,
            self.frame,
            &found.prior,
            &found.estimate.errors,
            &labelled,
            &self.least,
            self.steps,
        );
        self.log_likelihood(&estimate, given, places)
    }

    /// Rates of the free rod's reactions in standard deviations of the noise, which the tangent criterion is of, too.
    pub fn rates(&self) -> f64 {
        self.least[Criterion::Tangent as usize]
    }

    /// The errors that remain after a correction by the estimate.
    fn remaining(&self, estimate: &ErrorEstimate) -> RemainingErrors {
        RemainingErrors { frame: self.frame, factor: estimate.factor, scatter: estimate.scatter, rates: self.rates() }
    }

    /// The log-likelihood with exactly these errors: no remaining ones widen the evidence.
    fn log_likelihood(&self, estimate: &ErrorEstimate, given: &Prior, mut places: Vec<Place>) -> f64 {
        let exact = RemainingErrors { factor: Joint::zeros(), scatter: self.least, ..self.remaining(estimate) };
        exact.update_evidence(self.rod, &estimate.errors, self.track, &mut places);
        let square = |k: usize| {
            let sigma = given.sigmas[k];
            if sigma > 0.0 { ((estimate.errors[k] - given.means[k]) / sigma).powi(2) } else { 0.0 }
        };
        label_log_likelihood(&places) - 0.5 * (0..SOURCES).map(square).sum::<f64>()
    }

    /// The places with their labels, as measured.
    pub fn labelled_places(&self, found: &[(Label, f64)]) -> Vec<LabelledPlace> {
        let of = |(place, found): (&Place, &(Label, f64))| {
            let tau = self.track.tau[place.index];
            LabelledPlace { tau, measured: place.fit.at(tau), weight: place.weight, label: found.0 }
        };
        self.places.iter().zip(found).map(of).collect()
    }
}
