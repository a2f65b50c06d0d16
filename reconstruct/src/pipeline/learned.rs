//! What a live scan has learned of the errors that all samples share.

use super::reading::Reason;
use crate::phase::{Label, Place, constrained};
use crate::point::{Clamp, Touch};
use crate::scan::Noise;
use crate::systematic::{Around, Errors, Shared, of_point};
use nalgebra::{Matrix2, Matrix3};
use rod_core::{Uniform, Units};

/// Places that the same errors count as one for, about. Smaller: labels are too sure of themselves. Larger: they are less sure than they
/// might be. Chosen by `tests/live_labels.rs` with other seeds.
const PLACES: f64 = 3.0;
/// What is taken off the samples of a live scan, and the errors that are left.
#[derive(Clone, Debug)]
pub(super) struct Learned {
    taken: Around,
    /// The same of corrected samples.
    left: Around,
    shared: Shared,
    /// Units of the rod as it was found.
    units: Units,
    /// The place and the label for which this covariance of the point was computed.
    point: Option<(usize, Label, Matrix2<f64>)>,
}

impl Learned {
    /// None where what is to be taken off leaves fewer than three channels.
    pub fn new(taken: Errors, shared: Shared, units: Units) -> Option<Self> {
        let (taken, left) = (shared.around(&taken)?, shared.around(&Errors::zeros())?);
        Some(Self { taken, left, shared, units, point: None })
    }

    pub fn units(&self) -> Units {
        self.units
    }

    /// Gives a place the evidence of corrected samples, with the errors that are left in its standard deviations.
    pub fn judge(&self, tau: f64, place: &mut Place) {
        let evidence = self.shared.evidence(&self.taken, tau, place, &mut None, PLACES);
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
        let here = self.taken.here().apply(tau, &clamp, &measured.rate);
        let touch = constrained(&Uniform, &here.0, &covariance, label)?;
        let systematic = match self.point {
            Some((index, of, found)) if index == place.index && of == label => found,
            _ => {
                let corrected = measured.moved(here.0, here.1);
                let found = of_point(&self.left, tau, &corrected, &covariance, label, &self.shared.factor, 0.0);
                let earlier = self.point.filter(|point| point.1 == label).map(|point| point.2);
                let found = found.or(earlier).ok_or(Reason::Unshared)?;
                self.point = Some((place.index, label, found));
                found
            }
        };
        Ok(touch.with_systematic(systematic))
    }
}
