//! Consecutive points of a run, averaged until their noise is smaller than their distance.
//!
//! The bins are cut by the index of the sample, never by the position of the noisy points: a mean over points that are selected by
//! their own noise would be biased.

use super::measured::ContactPoint;
use super::scatter;
use nalgebra::{Matrix2, Vector2};

/// Smallest mean distance of neighbouring bins, in their standard deviations. Larger: smoother contours with fewer points.
const APART: f64 = 4.0;
/// Fewest bins of a run, unless it has fewer points.
const FEWEST: usize = 8;

/// The mean of some consecutive points.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointBin {
    /// Its first sample and the one after its last.
    pub from: usize,
    pub to: usize,
    pub at: Vector2<f64>,
    /// Covariance of `at`.
    pub covariance: Matrix2<f64>,
    /// Bias of the mean, m, because a point is not linear in the reactions: the square of the error of the rod's angles, times half
    /// the length over which they act.
    pub bias: f64,
    /// Tangent of the contour, a unit vector.
    pub tangent: Vector2<f64>,
    /// Standard deviation of its angle, radians; infinite where the contact force is lost in noise.
    pub sigma_tangent: f64,
}

/// The bins of a run whose points have covariances.
pub(super) fn bins(run: &[ContactPoint]) -> Vec<PointBin> {
    let parts = parts(run);
    // where no force is known, all tangents have the same weight
    let forceless = run.iter().all(|point| point.force.norm() == 0.0);
    let force = |point: &ContactPoint| if forceless { point.tangent } else { point.force };
    let force_noise = scatter::variance(run.iter().map(force), |_| Matrix2::identity()).unwrap_or(0.0);
    let mut forces = Vec::with_capacity(parts.len());
    let mut bins: Vec<PointBin> = parts
        .into_iter()
        .filter_map(|part| {
            let (first, last, many) = (part.first()?, part.last()?, part.len() as f64);
            let covariance = part.iter().map(|point| point.covariance).sum::<Matrix2<f64>>() / (many * many);
            // the mean of the force vectors, whose errors are the same, not of the angles
            let force = part.iter().map(force).sum::<Vector2<f64>>() / many;
            let bias =
                part.iter().map(|point| 0.5 * point.covariance.trace() / (point.shared * point.s)).sum::<f64>() / many;
            forces.push((force, force_noise / many));
            let (from, to) = (first.sample, last.sample + 1);
            Some(PointBin { from, to, at: mean(part).0, covariance, bias, tangent: force, sigma_tangent: 0.0 })
        })
        .collect();
    if run.len() > bins.len() {
        // Noise that is not white is larger in the means than white noise would be.
        let excess = scatter::variance(bins.iter().map(|bin| bin.at), |k| bins[k].covariance).unwrap_or(1.0);
        if excess > 1.0 && excess.is_finite() {
            bins.iter_mut().for_each(|bin| bin.covariance *= excess);
        }
        let scatter = scatter::variance(forces.iter().map(|&(force, _)| force), |_| Matrix2::identity()).unwrap_or(0.0);
        forces.iter_mut().for_each(|(_, variance)| *variance = variance.max(scatter));
    }
    for (bin, &(force, variance)) in bins.iter_mut().zip(&forces) {
        let size = force.norm();
        let known = size > 0.0;
        bin.tangent = if known { force / size } else { Vector2::x() };
        bin.sigma_tangent = if known { variance.sqrt() / size } else { f64::INFINITY };
    }
    bins
}

/// The points of each bin: as many bins of equal size as their mean distance allows. Bins in which the contact moves much faster are
/// halved.
fn parts(run: &[ContactPoint]) -> Vec<&[ContactPoint]> {
    let count = count(run);
    let mut parts = Vec::with_capacity(count);
    for k in 0..count {
        halve(&run[k * run.len() / count..(k + 1) * run.len() / count], &mut parts);
    }
    parts
}

/// Halves a part as long as its halves are far enough apart.
fn halve<'a>(part: &'a [ContactPoint], parts: &mut Vec<&'a [ContactPoint]>) {
    let (first, second) = part.split_at(part.len() / 2);
    let apart = !first.is_empty() && {
        let ((a, noise_a), (b, noise_b)) = (mean(first), mean(second));
        2.0 * (b - a).norm_squared() / (noise_a + noise_b) >= 2.0 * APART * APART
    };
    if apart {
        halve(first, parts);
        halve(second, parts);
    } else {
        parts.push(part);
    }
}

/// The mean of some points, one at least, and the trace of its covariance.
fn mean(part: &[ContactPoint]) -> (Vector2<f64>, f64) {
    let many = part.len() as f64;
    // relative to the first point, against rounding
    let sum: Vector2<f64> = part.iter().map(|point| point.at - part[0].at).sum();
    let variance: f64 = part.iter().map(|point| point.covariance.trace()).sum();
    (part[0].at + sum / many, variance / (many * many))
}

/// The number of bins of equal size.
fn count(run: &[ContactPoint]) -> usize {
    let mut size = 1;
    while run.len() / (2 * size) >= FEWEST {
        let means = run.chunks_exact(size).map(mean);
        // Squared distances in units of the variance; noise contributes 2. Each counts at most four times the limit.
        let (mut sum, mut before) = (0.0, None);
        for (mean, variance) in means {
            if let Some((last, noise)) = before.replace((mean, variance)) {
                let square: Vector2<f64> = mean - last;
                sum += (2.0 * square.norm_squared() / (variance + noise)).min(4.0 * APART * APART);
            }
        }
        if sum / (run.len() / size - 1) as f64 >= APART * APART + 2.0 {
            break;
        }
        size *= 2;
    }
    run.len().div_ceil(size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;

    #[test]
    fn bins_are_farther_apart_than_they_are_uncertain() {
        let (sigma, force_noise) = (5e-4, 2.5e-3);
        let mut random = Random::new(1);
        let mut run: Vec<ContactPoint> = (0..20_000)
            .map(|sample| {
                let at = Vector2::new(sample as f64 * 2e-6 + sigma * random.normal(), sigma * random.normal());
                let force = Vector2::new(0.2 + force_noise * random.normal(), force_noise * random.normal());
                ContactPoint {
                    sample,
                    at,
                    force,
                    tangent: Vector2::x(),
                    s: f64::INFINITY,
                    covariance: Matrix2::identity() * sigma * sigma,
                    shared: 1.0,
                }
            })
            .collect();
        scatter::complete(&mut run);
        let bins = bins(&run);
        assert!(bins.len() > 60 && bins.len() < 400, "{}", bins.len());
        assert_eq!((bins[0].from, bins.last().unwrap().to), (0, 20_000));
        let each = 20_000.0 / bins.len() as f64;
        let tangents: f64 = bins.iter().map(|bin| (bin.tangent.y / bin.sigma_tangent).powi(2)).sum();
        assert!((tangents / bins.len() as f64 - 1.0).abs() < 0.3);
        assert!((bins[9].covariance[(0, 0)].sqrt() * each.sqrt() / sigma - 1.0).abs() < 0.3);
        assert!(bins[9].covariance[(0, 0)].sqrt() * 3.0 < 4e-2 / bins.len() as f64);
    }

    #[test]
    fn clean_points_are_left_alone() {
        let mut run: Vec<ContactPoint> = (0..100)
            .map(|sample| {
                let at = Vector2::new(sample as f64 * 1e-4, 0.0);
                ContactPoint {
                    sample,
                    at,
                    force: Vector2::zeros(),
                    tangent: Vector2::x(),
                    s: f64::INFINITY,
                    covariance: Matrix2::zeros(),
                    shared: 1.0,
                }
            })
            .collect();
        scatter::complete(&mut run);
        let bins = bins(&run);
        assert_eq!(bins.len(), 100);
        assert!(bins[3].sigma_tangent == 0.0 && bins[3].at == run[3].at);
    }
}
