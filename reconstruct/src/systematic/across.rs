//! How far errors that all samples share displace single contact points across the contour.

use super::correction::{Frame, motion, still};
use super::influence::{CorrectionDifferences, point_derivatives};
use super::source::{Errors, SOURCES, Source};
use crate::phase::{Label, constrained_contact};
use crate::scan::{LocalEstimate, Track, TrackIndex};
use nalgebra::{Matrix3, Vector3};
use rod_core::{Rod, Sample, Uniform};

/// Displacement across the contour of a single contact point by errors that all samples share, to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// In the order of [`Source::ALL`], m per unit of the source.
    by: [f64; SOURCES],
}

impl Influence {
    /// Of an error of one source, m per unit of that.
    pub fn of(&self, source: Source) -> f64 {
        self.by[source as usize]
    }
}

/// The influence of the errors on the contact point of every `stride`-th sample of a scan, with its number, where the label is A or B and
/// there is one. The samples are exact: take them from a simulation. `sigma` is the noise of f0x, f0y (N) and m0z (N m), by whose
/// ratios a reconstruction moves reactions onto the conditions of a phase; `friction` is the coefficient of friction with the sign of
/// [`Source::Friction`], 0 without.
pub fn influences(
    rod: &Rod,
    samples: &[Sample],
    labels: &[Label],
    sigma: [f64; 3],
    friction: f64,
    stride: usize,
) -> Vec<(usize, Influence)> {
    let (track, indices) = Track::new(rod, samples);
    let track = track.with_friction(friction);
    let units = rod.units();
    let around = Frame::of(&track).and_then(|frame| CorrectionDifferences::new(frame, &Errors::zeros(), |_| true));
    let Some(around) = around else { return Vec::new() };
    let noise = Vector3::from(sigma).component_div(&Vector3::new(units.force, units.force, units.moment));
    // without noise there are no ratios
    let least = noise.amax().max(f64::MIN_POSITIVE) * 1e-6;
    let noise = Matrix3::from_diagonal(&noise.map(|sigma| sigma.max(least).powi(2)));
    let one = |number: usize, label: Label, TrackIndex(index): TrackIndex| {
        let clamp = track.clamps[index];
        let estimate = LocalEstimate::exact(clamp, still(motion(&track, index)));
        let (by, _) = point_derivatives(&Uniform, &around, track.tau[index], &estimate, &noise, label)?;
        let alpha = constrained_contact(&Uniform, &clamp, &noise, label).ok()?.alpha;
        let across = |k: usize| alpha.cos() * by[(1, k)] - alpha.sin() * by[(0, k)];
        let by = std::array::from_fn(|k| across(k) * units.length / Source::ALL[k].unit(rod));
        by.iter().all(|v| v.is_finite()).then_some((number, Influence { by }))
    };
    let all = indices.iter().zip(labels).enumerate().step_by(stride.max(1));
    let single = all.filter(|(_, (_, label))| matches!(label, Label::A | Label::B));
    single.filter_map(|(number, (index, label))| one(number, *label, *index.as_ref().ok()?)).collect()
}
