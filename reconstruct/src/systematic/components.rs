//! The few combinations of shared errors that matter along a stretch.

use super::calibrate::RemainingErrors;
use super::correction::Correction;
use super::influence::POINT_INPUTS;
use super::source::{Errors, Joint};
use crate::phase::Place;
use crate::scan::Track;
use nalgebra::SymmetricEigen;
use std::ops::Range;

/// Most combinations. More: more time, as each costs a step of the stretch's least squares.
const MOST: usize = 6;
/// Smallest part of the largest combination's standard deviation that counts.
const SMALLEST: f64 = 0.03;
/// The displacement in standard deviations. Larger: terms of second order count; smaller: rounding does.
pub(crate) const DISPLACED: f64 = 0.03;
/// Places of a stretch from which the combinations are found.
const PLACES: usize = 16;

impl RemainingErrors {
    /// Displacements of the samples of a stretch, by [`DISPLACED`] standard deviations of each combination of errors that matters there.
    pub fn displacements(&self, track: &Track, places: &[Place], stretch: &Range<usize>) -> Vec<Correction> {
        let moved = |errors: &Errors| Correction::new(self.frame, &(errors * DISPLACED));
        self.combinations(track, places, stretch).iter().filter_map(moved).collect()
    }

    fn combinations(&self, track: &Track, places: &[Place], stretch: &Range<usize>) -> Vec<Errors> {
        let inside: Vec<&Place> = places.iter().filter(|place| stretch.contains(&place.index)).collect();
        let mut squares = Joint::zeros();
        let Some(around) = self.differences(&Errors::zeros()) else { return Vec::new() };
        for place in inside.iter().step_by(inside.len().div_ceil(PLACES).max(1)) {
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
