//! What a live scan has learned of the errors that all samples share.

use super::reading::Reason;
use crate::phase::{Label, Place, constrained_contact};
use crate::point::{Clamp, Touch};
use crate::scan::Noise;
use crate::systematic::{CorrectionDifferences, Errors, RemainingErrors, point_covariance};
use nalgebra::{Matrix2, Matrix3};
use rod_core::{Uniform, Units};

/// Places that the same errors count as one for, about. Smaller: labels are too sure of themselves. Larger: they are less sure than they
/// might be. Chosen by `tests/live_labels.rs` with other seeds.
const PLACES: f64 = 3.0;

/// The errors that are subtracted from the samples of a live scan, and those that remain.
#[derive(Clone, Debug)]
pub(super) struct Learned {
    subtracted: CorrectionDifferences,
    /// The same of corrected samples.
    remaining: CorrectionDifferences,
    shared: RemainingErrors,
    /// Units of the rod as it was found.
    units: Units,
    /// The place and the label for which this covariance of the point was computed.
    point: Option<(usize, Label, Matrix2<f64>)>,
}

impl Learned {
    /// None where the gains and cross-talk that are subtracted leave fewer than three channels.
    pub fn new(taken: Errors, shared: RemainingErrors, units: Units) -> Option<Self> {
        let (subtracted, remaining) = (shared.differences(&taken)?, shared.differences(&Errors::zeros())?);
        Some(Self { subtracted, remaining, shared, units, point: None })
    }

    pub fn units(&self) -> Units {
        self.units
    }

    /// Gives a place the evidence of corrected samples, with the errors that are left in its standard deviations.
    pub fn judge(&self, tau: f64, place: &mut Place) {
        let evidence = self.shared.evidence(&Uniform, &self.subtracted, tau, place, &mut None, PLACES);
        place.set_evidence(evidence.weak());
    }

    /// The contact at a sample of phase A or B, dimensionless in the units of the rod as it was found.
    pub fn contact(
        &mut self,
        sample: &Clamp,
        tau: f64,
        place: &Place,
        noise: &Noise,
        label: Label,
    ) -> Result<Touch, Reason> {
        let measured = place.fit.at(tau);
        let (clamp, covariance) = if noise.is_clean() {
            (*sample, Matrix3::from_diagonal(&noise.variance))
        } else {
            (measured.clamp, measured.covariance())
        };
        let here = self.subtracted.here().apply(tau, &clamp, &measured.rate);
        let touch = constrained_contact(&Uniform, &here.0, &covariance, label)?;
        let systematic = match self.point {
            Some((index, of, found)) if index == place.index && of == label => found,
            _ => {
                let corrected = measured.moved(here.0, here.1);
                let found = point_covariance(
                    &Uniform,
                    &self.remaining,
                    tau,
                    &corrected,
                    &covariance,
                    label,
                    (&self.shared.factor, 0.0),
                );
                let earlier = self.point.filter(|point| point.1 == label).map(|point| point.2);
                let found = found.or(earlier).ok_or(Reason::Unshared)?;
                self.point = Some((place.index, label, found));
                found
            }
        };
        Ok(touch.with_systematic(systematic))
    }
}
