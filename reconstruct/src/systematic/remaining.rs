//! The errors that remain after the correction of a scan: the evidence with them, and the few combinations of them that matter along a
//! stretch.

use super::correction::{Correction, Frame};
use super::influence::{CorrectionDifferences, POINT_INPUTS, criteria_derivatives, point_covariance, variances};
use super::source::{Errors, Joint};
use crate::phase::{CRITERIA, Criterion, Evidence, Label, Place};
use crate::point::Inverse;
use crate::scan::{Noise, Track};
use nalgebra::{Matrix2, Matrix3, SymmetricEigen};
use std::ops::Range;

/// Most places that the errors are estimated from, besides those next to kinks. More: more time.
pub(super) const PLACES: usize = 800;
/// Most combinations. More: more time, as each costs a step of the stretch's least squares.
const MOST: usize = 6;
/// Smallest part of the largest combination's standard deviation that counts.
const SMALLEST: f64 = 0.03;
/// The displacement in standard deviations. Larger: terms of second order count; smaller: rounding does.
pub(crate) const DISPLACED: f64 = 0.03;
/// Places of a stretch from which the combinations are found.
const STRETCH_PLACES: usize = 16;

/// The shared errors that remain after the correction.
#[derive(Clone, Debug)]
pub(crate) struct RemainingErrors {
    pub frame: Frame,
    /// Factor of the covariance of the errors.
    pub factor: Joint,
    /// Residuals of each criterion in standard deviations of the noise, 1 at least.
    pub scatter: [f64; CRITERIA],
    /// Rates of the free rod's reactions in standard deviations of the noise, 1 at least: more where the sensor drifts at random.
    pub rates: f64,
}

impl RemainingErrors {
    /// Replaces the evidence of each place by that after a correction, with these errors in its standard deviations.
    pub fn update_evidence<I: Inverse>(&self, rod: &I, errors: &Errors, track: &Track, places: &mut [Place]) {
        let Some(around) = self.differences(errors) else { return };
        let stride = places.len().div_ceil(PLACES).max(1);
        let mut shared = None;
        for (k, place) in places.iter_mut().enumerate() {
            // the influence of the errors changes little from place to place
            if k % stride == 0 || place.observation.between.is_some() {
                shared = None;
            }
            let evidence = self.evidence(rod, &around, track.tau[place.index], place, &mut shared, 1.0);
            place.set_evidence(evidence);
        }
    }

    /// The evidence of one place. `shared` are the variances of the criteria by the errors: none where they are to be computed anew. So many
    /// places, `sharing`, have the same errors.
    pub fn evidence<I: Inverse>(
        &self,
        rod: &I,
        around: &CorrectionDifferences,
        tau: f64,
        place: &Place,
        shared: &mut Option<[f64; CRITERIA]>,
        sharing: f64,
    ) -> Evidence {
        let measured = place.fit.at(tau);
        let here = around.here().apply(tau, &measured.clamp, &measured.rate);
        let mut evidence = Evidence::of(rod, &measured.moved(here.0, here.1));
        let of_errors = || {
            if around.is_exact() {
                return [0.0; CRITERIA];
            }
            variances(&criteria_derivatives(rod, &here, &around.input_derivatives(tau, &measured), true), &self.factor)
        };
        let shared = shared.get_or_insert_with(of_errors);
        let quantities = evidence.quantities();
        let variances = std::array::from_fn(|c| {
            let misfit = quantities[c].sigma.powi(2) * (self.scatter[c].powi(2) - 1.0);
            let both = shared[c] + misfit;
            if both.is_finite() { both } else { 0.0 }
        });
        evidence.widen(&variances, sharing);
        evidence
    }

    /// The correction by these errors, and by these with a step of each of which anything is not known.
    pub fn differences(&self, errors: &Errors) -> Option<CorrectionDifferences> {
        CorrectionDifferences::new(self.frame, errors, |k| self.factor.row(k).iter().any(|by| *by != 0.0))
    }

    /// Divides the scores of breaks by the excess variance of the rates of the reactions.
    pub fn weaken_breaks(&self, places: &mut [Place]) {
        for between in places.iter_mut().filter_map(|place| place.observation.between.as_mut()) {
            between.score /= self.rates * self.rates;
        }
    }

    /// For each place of phase A or B the covariance of its contact point that the errors cause, dimensionless; the places are corrected.
    /// None where no place of a run has one.
    pub fn point_covariances<I: Inverse>(
        &self,
        rod: &I,
        track: &Track,
        noise: &Noise,
        places: &[Place],
        labels: &[(Label, f64)],
    ) -> Vec<Option<Matrix2<f64>>> {
        let Some(around) = self.differences(&Errors::zeros()) else { return vec![None; places.len()] };
        let stride = places.len().div_ceil(PLACES).max(1);
        let of = |place: &Place, label: Label| {
            let tau = track.tau[place.index];
            let measured = place.fit.at(tau);
            let covariance = if noise.is_clean() { Matrix3::zeros() } else { measured.covariance() };
            let criterion = if label == Label::A { Criterion::Length } else { Criterion::K };
            let misfit = self.scatter[criterion as usize].powi(2) - 1.0;
            point_covariance(rod, &around, tau, &measured, &covariance, label, (&self.factor, misfit))
        };
        // a force that has hardly begun has no derivatives: such a place takes those of the nearest place of its label
        let mut found: Vec<Option<Matrix2<f64>>> = Vec::with_capacity(places.len());
        for (k, (place, &(label, _))) in places.iter().zip(labels).enumerate() {
            let before = k.checked_sub(1).filter(|before| labels[*before].0 == label).and_then(|before| found[before]);
            let own = before.is_none() || k % stride == 0;
            found.push(if matches!(label, Label::A | Label::B) && own { of(place, label).or(before) } else { before });
        }
        for k in (1..places.len()).rev() {
            if found[k - 1].is_none() && labels[k - 1].0 == labels[k].0 {
                found[k - 1] = found[k];
            }
        }
        found
    }
}

impl RemainingErrors {
    /// Displacements of the samples of a stretch, by [`DISPLACED`] standard deviations of each combination of errors that matters there.
    pub fn displacements(&self, track: &Track, places: &[Place], stretch: &Range<usize>) -> Vec<Correction> {
        let moved = |errors: &Errors| Correction::new(self.frame, &(errors * DISPLACED));
        self.combinations(track, places, stretch).iter().filter_map(moved).collect()
    }

    /// The combinations, each one standard deviation large, the largest first.
    fn combinations(&self, track: &Track, places: &[Place], stretch: &Range<usize>) -> Vec<Errors> {
        let inside: Vec<&Place> = places.iter().filter(|place| stretch.contains(&place.index)).collect();
        let mut squares = Joint::zeros();
        let Some(around) = self.differences(&Errors::zeros()) else { return Vec::new() };
        for place in inside.iter().step_by(inside.len().div_ceil(STRETCH_PLACES).max(1)) {
            let tau = track.tau[place.index];
            let spread = around.input_derivatives(tau, &place.fit.at(tau)).fixed_rows::<POINT_INPUTS>(0) * self.factor;
            squares += spread.transpose() * spread;
        }
        let eigen = SymmetricEigen::new(squares);
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
        let least = eigen.eigenvalues[order[0]] * SMALLEST * SMALLEST;
        let matters = order.into_iter().take(MOST).filter(|k| eigen.eigenvalues[*k] > least.max(f64::MIN_POSITIVE));
        matters.map(|k| self.factor * eigen.eigenvectors.column(k)).collect()
    }
}
