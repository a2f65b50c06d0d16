//! How well a scan determines the contour: the standard deviation across it, before the scan is made.
//!
//! The unknowns are normal offsets of the contour, a cubic B-spline of arc length. A contact at arc length l moves with the offset w(l) along the
//! normal and turns with w'(l); [`Derivatives`] gives the change of the reactions by both. The covariance is the inverse of the normal matrix of
//! all states, with the noise of the samples that each stands for, and the prior of the fit of a recording: small changes of curvature, and offsets of a
//! few hundredths of the rod. All contacts count, single and several.

use crate::Outline;
use nalgebra::{DMatrix, DVector, Vector3};
use rod_contact::{Derivatives, State};
use rod_contours::Composite;
use rod_core::{PhysicalRod, SupportRate};
use rod_reconstruct::FittedObject;
use rod_reconstruct::noise_estimate::ChannelNoise;

/// What is measured along a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Standard deviation of a sample of f0x, f0y (N) and m0z (N m).
    pub sigma: [f64; 3],
    /// Variance of the mean of many samples over that of independent ones: 1 for white noise.
    pub long_run: [f64; 3],
    /// Way of the clamp from one sample to the next, m: speed over rate.
    pub spacing: f64,
    /// Distance of the points of the contour that the fit will have, m.
    pub resolution: f64,
    /// Standard deviation of the change of curvature over a length of way, 1/m per root of m: how smooth the contour is.
    pub bend: f64,
}

/// The least change of curvature per root of way that a contour is expected to have, L^-1.5: of a nearly straight or round contour the fit determines
/// it from noise.
const LEAST_BEND: f64 = 1.0;

/// Distance of the points of a fit where none are known yet, rod lengths.
const RESOLUTION: f64 = 0.02;

impl Measurement {
    /// With the resolution and the smoothness that the contour has now, for a sensor with this noise of f0x, f0y (N) and m0z (N m), a sample
    /// every `spacing` (m) of the clamp's way, and a rod of this length (m).
    pub fn of(noise: &[ChannelNoise; 3], spacing: f64, known: &[FittedObject], length: f64) -> Self {
        let (mut ways, mut changes) = (Vec::new(), Vec::new());
        for contour in known {
            let is_touched = |k: usize| contour.known[k].sigma().is_some();
            let way = |k: usize| {
                let [from, to] = [contour.points[k], contour.points[k + 1]];
                (to[0] - from[0]).hypot(to[1] - from[1])
            };
            let turn = |k: usize| {
                let angle = |k: usize| {
                    let [from, to] = [contour.points[k], contour.points[k + 1]];
                    (to[1] - from[1]).atan2(to[0] - from[0])
                };
                let turn = angle(k) - angle(k - 1);
                turn.sin().atan2(turn.cos())
            };
            for k in 1..contour.points.len().saturating_sub(2) {
                if (k - 1..=k + 2).all(is_touched) && (k..=k + 1).all(|k| !contour.vertices.contains(&k)) {
                    let curvature = |k: usize| 2.0 * turn(k) / (way(k - 1) + way(k));
                    ways.push(way(k));
                    changes.push((curvature(k + 1) - curvature(k)).powi(2) / way(k));
                }
            }
        }
        ways.sort_by(f64::total_cmp);
        let bend = (changes.iter().sum::<f64>() / changes.len().max(1) as f64).sqrt();
        Self {
            sigma: noise.each_ref().map(|channel| channel.sigma),
            long_run: noise.each_ref().map(|channel| channel.long_run),
            spacing,
            resolution: ways.get(ways.len() / 2).copied().unwrap_or(RESOLUTION * length),
            bend: bend.max(LEAST_BEND * length.powf(-1.5)),
        }
    }
}

/// Standard deviation of an offset about the start of the fit, rod lengths: that of the fit.
const OFFSET: f64 = 0.03;

/// Number of blocks that the fit of a recording takes the mean of, and their least standard deviation as a share of the largest reaction: those of the fit.
const BLOCKS: f64 = 600.0;
const LEAST: f64 = 3e-4;

/// The predicted standard deviation at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceSigma {
    /// Number of the object, from 0.
    pub object: usize,
    /// Arc length, m.
    pub place: f64,
    /// Across the contour, m.
    pub sigma: f64,
}

/// The predicted standard deviations at points a [resolution](Measurement::resolution) apart that a contact comes nearest to. `states` are those of
/// one scan at equal distances; `way` is its whole length, m.
pub(crate) fn predicted<R: PhysicalRod>(
    rod: &R,
    objects: &[Composite],
    outlines: &[Outline],
    states: &[State],
    way: f64,
    measurement: &Measurement,
) -> Vec<PlaceSigma> {
    let Some(weights) = weights(states, way, measurement) else { return Vec::new() };
    let mut bases: Vec<Basis> = Vec::new();
    for outline in outlines {
        let first = bases.last().map_or(0, |basis| basis.first + basis.count());
        bases.push(Basis::new(outline.length(), measurement.resolution, first));
    }
    let unknowns = bases.last().map_or(0, |basis| basis.first + basis.count());
    let mut normal = DMatrix::<f64>::zeros(unknowns, unknowns);
    let mut touched: Vec<Vec<bool>> = bases.iter().map(|basis| vec![false; basis.nodes]).collect();
    for state in states.iter().filter(|state| !state.contacts.is_empty()) {
        let Ok(derivatives) = Derivatives::new(rod, objects, state) else { continue };
        let mut rates: Vec<(usize, Vector3<f64>)> = Vec::new();
        for (number, contact) in state.contacts.iter().enumerate() {
            let (outline, basis) = (&outlines[contact.object], &bases[contact.object]);
            let Some(place) = outline.place(&objects[contact.object], contact) else { continue };
            let (sin, cos) = contact.alpha.sin_cos();
            let response = |rate: SupportRate| {
                let found =
                    derivatives.by_contours(|other| if other == number { rate } else { SupportRate::default() });
                found.ok().map(|found| Vector3::new(found.reactions.f0x, found.reactions.f0y, found.reactions.m0z))
            };
            let shifted = response(SupportRate { x: -sin, y: cos, alpha: 0.0 });
            let turned = response(SupportRate { x: 0.0, y: 0.0, alpha: 1.0 });
            let (Some(shifted), Some(turned)) = (shifted, turned) else { continue };
            rates.extend(basis.at(place).into_iter().map(|(i, value, slope)| (i, shifted * value + turned * slope)));
            touched[contact.object][basis.nearest(place)] = true;
        }
        for (i, one) in &rates {
            for (j, other) in &rates {
                normal[(*i, *j)] += one.component_mul(&weights).dot(other);
            }
        }
    }
    for basis in &bases {
        basis.add_prior(&mut normal, OFFSET * rod.units().length, measurement);
    }
    let Some(inverse) = normal.cholesky().map(|factor| factor.inverse()) else { return Vec::new() };
    let mut sigmas = Vec::new();
    for (object, basis) in bases.iter().enumerate() {
        for node in (0..basis.nodes).filter(|node| touched[object][*node]) {
            let place = node as f64 * basis.spacing;
            let mut row = DVector::zeros(unknowns);
            basis.at(place).into_iter().for_each(|(i, value, _)| row[i] = value);
            let variance = (&inverse * &row).dot(&row);
            sigmas.push(PlaceSigma { object, place, sigma: variance.max(0.0).sqrt() });
        }
    }
    sigmas
}

/// One over the variance of the channels for each state.
fn weights(states: &[State], way: f64, measurement: &Measurement) -> Option<Vector3<f64>> {
    let last = states.len().checked_sub(1).filter(|last| *last > 0)?;
    let samples = way / measurement.spacing;
    let (of_state, of_block) = (samples / last as f64, samples / BLOCKS);
    let channels = |state: &State| [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z].map(f64::abs);
    let largest =
        states.iter().map(channels).fold([0.0_f64; 3], |most, one| std::array::from_fn(|c| most[c].max(one[c])));
    let force = largest[0].max(largest[1]);
    let of_channel = |c: usize| {
        let floor = LEAST * if c < 2 { force } else { largest[2] };
        let variance = measurement.sigma[c].powi(2) * measurement.long_run[c] / of_block;
        of_state / of_block / variance.max(floor * floor)
    };
    Some(Vector3::new(of_channel(0), of_channel(1), of_channel(2)))
}

/// Cubic B-splines on evenly spaced nodes.
struct Basis {
    /// Number of the first unknown.
    first: usize,
    nodes: usize,
    /// m
    spacing: f64,
}

impl Basis {
    fn new(length: f64, resolution: f64, first: usize) -> Self {
        let intervals = (length / resolution).round().max(1.0);
        Self { first, nodes: intervals as usize + 1, spacing: length / intervals }
    }

    fn count(&self) -> usize {
        self.nodes + 2
    }

    fn nearest(&self, place: f64) -> usize {
        ((place / self.spacing).round().max(0.0) as usize).min(self.nodes - 1)
    }

    /// The unknowns that matter at a place (m), with the value and the slope (1/m) of their splines.
    fn at(&self, place: f64) -> [(usize, f64, f64); 4] {
        let at = (place / self.spacing).clamp(0.0, (self.nodes - 1) as f64);
        let interval = (at as usize).min(self.nodes.saturating_sub(2));
        let u = at - interval as f64;
        let v = 1.0 - u;
        let values = [v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0, 3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u];
        let slopes = [-3.0 * v * v, 9.0 * u * u - 12.0 * u, -9.0 * v * v + 12.0 * v, 3.0 * u * u];
        std::array::from_fn(|k| (self.first + interval + k, values[k] / 6.0, slopes[k] / 6.0 / self.spacing))
    }

    /// Offsets of this standard deviation (m), and small changes of curvature.
    fn add_prior(&self, normal: &mut DMatrix<f64>, offset: f64, measurement: &Measurement) {
        for node in 0..self.nodes {
            let row = self.at(node as f64 * self.spacing);
            for (i, one, _) in row {
                for (j, other, _) in row {
                    normal[(i, j)] += one * other / (offset * offset);
                }
            }
        }
        // the curvature of a cubic B-spline at a node is the second difference of its coefficients over spacing^2
        let scale = 1.0 / (self.spacing.powi(2) * measurement.bend * self.spacing.sqrt());
        let third = [-1.0, 3.0, -3.0, 1.0].map(|share| share * scale);
        for first in 0..self.count().saturating_sub(3) {
            for (k, one) in third.iter().enumerate() {
                for (l, other) in third.iter().enumerate() {
                    normal[(self.first + first + k, self.first + first + l)] += one * other;
                }
            }
        }
        // natural ends
        for first in [0, self.count() - 3] {
            for (k, one) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                for (l, other) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                    let index = (self.first + first + k, self.first + first + l);
                    normal[index] += one * other * (scale * scale);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_are_a_partition_of_one_and_reproduce_lines() {
        let basis = Basis::new(1.0, 0.1, 0);
        assert_eq!((basis.nodes, basis.count()), (11, 13));
        for place in [0.0, 0.03, 0.5, 0.77, 1.0] {
            let at = basis.at(place);
            assert!((at.iter().map(|one| one.1).sum::<f64>() - 1.0).abs() < 1e-14);
            // coefficients of a line are its values at the nodes
            let line: f64 = at.iter().map(|(i, value, _)| value * (*i as f64 - 1.0) * 0.1).sum();
            let slope: f64 = at.iter().map(|(i, _, slope)| slope * (*i as f64 - 1.0) * 0.1).sum();
            assert!((line - place).abs() < 1e-14 && (slope - 1.0).abs() < 1e-12);
        }
    }
}
