//! Labels and shared errors in turns, from a given start.

use super::adjust::{Adjusted, Labelled, Prior, adjust};
use super::calibrate::Shared;
use super::calibration::BEYOND;
use super::correction::Frame;
use super::source::{Errors, Joint, SOURCES};
use crate::phase::{CRITERIA, Criterion, Label, Place, label_log_likelihood, most_likely_labels};
use crate::scan::Track;

/// Most turns of labelling and estimating.
const TURNS: usize = 6;
/// Factor by which a budget is raised that an estimate contradicts.
pub(super) const RAISED: f64 = 3.0;

/// A scan whose labels and errors are to be found.
#[derive(Clone, Copy)]
pub(super) struct Turns<'a> {
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
pub(super) struct Found {
    pub adjusted: Adjusted,
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

impl Turns<'_> {
    /// The likelier of what two starts lead to: the recording as it is, and any recording within the budget. From the second one a scan
    /// with large errors is labelled; with it alone, wrong labels of a good scan might agree with large errors.
    pub fn found(&self, prior: &Prior, tared: &Adjusted) -> Found {
        let as_is = Adjusted { errors: prior.means, factor: Joint::zeros(), ..tared.clone() };
        let [as_is, any] = [&as_is, tared].map(|start| self.lead(prior, start));
        if as_is.likelihood >= any.likelihood { as_is } else { any }
    }

    fn lead(&self, given: &Prior, start: &Adjusted) -> Found {
        let (mut adjusted, mut prior, mut raised) = (start.clone(), *given, [false; SOURCES]);
        let mut judged = self.places.to_vec();
        self.left(&adjusted).doubt(&mut judged);
        let mut before: Vec<(Label, f64)> = Vec::new();
        for _ in 0..TURNS {
            self.left(&adjusted).judge(&adjusted.errors, self.track, &mut judged);
            let now = most_likely_labels(&judged, false);
            adjusted = adjust(self.frame, &prior, &adjusted.errors, &self.labelled(&now), &self.least, self.steps);
            let again = raise(&mut prior, &adjusted.errors, &mut raised);
            let same = now.iter().zip(&before).all(|(now, before)| now.0 == before.0) && now.len() == before.len();
            before = now;
            if same && !again {
                break;
            }
        }
        let likelihood = self.log_likelihood(&adjusted, given, judged);
        Found { adjusted, prior, raised, labels: before, likelihood }
    }

    /// The likelihood after one more turn, on these places, from what was found on others. `given` is what was known before.
    pub fn last(&self, given: &Prior, found: &Found) -> f64 {
        let mut judged = self.places.to_vec();
        let left = self.left(&found.adjusted);
        left.doubt(&mut judged);
        left.judge(&found.adjusted.errors, self.track, &mut judged);
        let places = self.labelled(&most_likely_labels(&judged, false));
        let adjusted = adjust(self.frame, &found.prior, &found.adjusted.errors, &places, &self.least, self.steps);
        self.log_likelihood(&adjusted, given, judged)
    }

    /// Rates of the free rod's reactions in standard deviations of the noise, which the tangent criterion is of, too.
    pub fn rates(&self) -> f64 {
        self.least[Criterion::Tangent as usize]
    }

    fn left(&self, adjusted: &Adjusted) -> Shared {
        Shared { frame: self.frame, factor: adjusted.factor, scatter: adjusted.scatter, rates: self.rates() }
    }

    /// The likelihood with exactly these errors: no others widen the evidence.
    fn log_likelihood(&self, adjusted: &Adjusted, given: &Prior, mut judged: Vec<Place>) -> f64 {
        let exact = Shared { factor: Joint::zeros(), scatter: self.least, ..self.left(adjusted) };
        exact.judge(&adjusted.errors, self.track, &mut judged);
        let square = |k: usize| {
            let sigma = given.sigmas[k];
            if sigma > 0.0 { ((adjusted.errors[k] - given.means[k]) / sigma).powi(2) } else { 0.0 }
        };
        label_log_likelihood(&judged) - 0.5 * (0..SOURCES).map(square).sum::<f64>()
    }

    /// The places with their labels, as measured.
    pub fn labelled(&self, found: &[(Label, f64)]) -> Vec<Labelled> {
        let of = |(place, found): (&Place, &(Label, f64))| {
            let tau = self.track.tau[place.index];
            Labelled { tau, measured: place.fit.at(tau), weight: place.weight, label: found.0 }
        };
        self.places.iter().zip(found).map(of).collect()
    }
}
