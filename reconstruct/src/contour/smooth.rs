//! The most likely positions of bins, from their own positions and the tangents of all.
//!
//! The step from one bin to the next is along the contour, whose direction the contact force gives far more exactly than the
//! positions do: n . (r_next - r) = 0 with n the normal at the mean angle of the two. This is right to second order in the step
//! and exact on a circle. Together with the positions these are linear equations in a chain, solved by one pass forwards and one
//! backwards (as a Kalman smoother): each bin gets from its neighbour an estimate of its normal coordinate and its variance.

use super::bins::PointBin;
use crate::numeric::{inverse, squared_distance};
use nalgebra::{Matrix2, Vector2};

/// Departure of the direction of a chord from the mean of the tangents at its ends, as a share of the change of the turning angle:
/// 1/12 on a smooth curve, more where a vertex begins.
const BEND: f64 = 0.25;

/// Smallest variance of a step, relative to that of its ends, so that rounding is no contradiction.
const SLACK: f64 = 1e-6;

/// A bin's position and its covariance.
pub(super) type BinEstimate = (Vector2<f64>, Matrix2<f64>);

/// The positions of the bins, with their own points alone or with the tangents.
pub(super) fn smooth(bins: &[PointBin], tangents: bool) -> Vec<BinEstimate> {
    let Some(first) = bins.first() else { return Vec::new() };
    let origin = first.at;
    let own: Vec<_> = bins.iter().map(|bin| (bin.at - origin, inverse(&bin.covariance))).collect();
    let turns: Vec<f64> = bins.windows(2).map(|pair| angle(&pair[0].tangent, &pair[1].tangent)).collect();
    let step = |k| if tangents { Step::to_bin(bins, &turns, k) } else { None };
    let steps: Vec<_> = (1..bins.len()).map(step).collect();
    let count = bins.len();
    // what each bin gets from the bins before it and from those after it: information vector and matrix
    let mut ahead = vec![(Vector2::zeros(), Matrix2::zeros()); count];
    let mut behind = ahead.clone();
    let with = |k: usize, from_neighbour: &(Vector2<f64>, Matrix2<f64>)| {
        let (at, weight) = &own[k];
        (weight * at + from_neighbour.0, weight + from_neighbour.1)
    };
    for k in 1..count {
        ahead[k] = Step::information(&steps[k - 1], with(k - 1, &ahead[k - 1]));
    }
    for k in (1..count).rev() {
        behind[k - 1] = Step::information(&steps[k - 1], with(k, &behind[k]));
    }
    let mut estimates: Vec<BinEstimate> = (0..count)
        .map(|k| {
            let (right, weight) = with(k, &(ahead[k].0 + behind[k].0, ahead[k].1 + behind[k].1));
            let covariance = inverse(&weight);
            (origin + covariance * right, covariance)
        })
        .collect();
    let excess = excess(bins, &steps, &estimates);
    if excess > 1.0 && excess.is_finite() {
        estimates.iter_mut().for_each(|(_, covariance)| *covariance *= excess);
    }
    estimates
}

/// The sum of squares of all residuals over its expected value.
fn excess(bins: &[PointBin], steps: &[Option<Step>], estimates: &[BinEstimate]) -> f64 {
    let freedom = steps.iter().flatten().count();
    let of_points = bins.iter().zip(estimates).map(|(bin, (at, _))| squared_distance(&(at - bin.at), &bin.covariance));
    let of_steps = steps.iter().zip(estimates.windows(2)).filter_map(|(step, pair)| {
        let step = step.as_ref()?;
        Some(step.normal.dot(&(pair[1].0 - pair[0].0)).powi(2) / step.variance)
    });
    if freedom == 0 { 1.0 } else { (of_points.sum::<f64>() + of_steps.sum::<f64>()) / freedom as f64 }
}

/// The step between two bins: across the contour it vanishes within a variance.
struct Step {
    normal: Vector2<f64>,
    /// Variance of the step along the normal.
    variance: f64,
}

impl Step {
    /// The step from the bin before to bin `k`, given the angle by which the tangent turns in each step; none where no
    /// tangent is known.
    fn to_bin(bins: &[PointBin], turns: &[f64], k: usize) -> Option<Self> {
        let (a, b) = (&bins[k - 1], &bins[k]);
        let tangent = (a.tangent + b.tangent).try_normalize(1e-6)?;
        let uncertain = a.sigma_tangent * a.sigma_tangent + b.sigma_tangent * b.sigma_tangent;
        if !uncertain.is_finite() {
            return None;
        }
        let here = turns[k - 1];
        let change = |beside: Option<&f64>| beside.map_or(0.0, |turn| (turn - here).abs());
        let bend = BEND * change(k.checked_sub(2).map(|k| &turns[k])).max(change(turns.get(k)));
        // The length of the step is uncertain, too. Without that, no step would connect the bins at a vertex.
        let way = (b.at - a.at).norm_squared() + a.covariance.trace() + b.covariance.trace();
        // the tangent of a bin enters two steps with the same sign: twice the variance of each alone
        let variance = way * (0.5 * uncertain + bend * bend) + SLACK * (a.covariance.trace() + b.covariance.trace());
        Some(Self { normal: Vector2::new(-tangent.y, tangent.x), variance })
    }

    /// The information that the bin at one end of a step gives the one at the other end.
    fn information(step: &Option<Self>, (right, weight): (Vector2<f64>, Matrix2<f64>)) -> (Vector2<f64>, Matrix2<f64>) {
        let Some(Self { normal, variance }) = step else { return (Vector2::zeros(), Matrix2::zeros()) };
        let covariance = inverse(&weight);
        let along = covariance * normal;
        let weight = 1.0 / (variance + normal.dot(&along));
        let offset = along.dot(&right);
        (normal * (offset * weight), normal * normal.transpose() * weight)
    }
}

/// The angle from one unit vector to another.
fn angle(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    (a.x * b.y - a.y * b.x).atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;

    /// Bins along a circle of radius 10 mm, 0.2 mm apart.
    fn circle(count: usize, sigma: f64, sigma_tangent: f64, seed: u64) -> Vec<PointBin> {
        let mut random = Random::new(seed);
        let bin = |k: usize| {
            let angle = 0.02 * k as f64;
            let noise = Vector2::new(random.normal(), random.normal()) * sigma;
            let at = Vector2::new(angle.sin(), 1.0 - angle.cos()) * 1e-2 + noise;
            let alpha = angle + sigma_tangent * random.normal();
            let (covariance, tangent) = (Matrix2::identity() * sigma * sigma, Vector2::new(alpha.cos(), alpha.sin()));
            PointBin { from: k, to: k + 1, at, covariance, bias: 0.0, tangent, sigma_tangent }
        };
        (0..count).map(bin).collect()
    }

    fn offset(at: &Vector2<f64>) -> f64 {
        (at - Vector2::new(0.0, 1e-2)).norm() - 1e-2
    }

    #[test]
    #[allow(clippy::print_stdout, reason = "the error that is measured is there to be read")]
    fn tangents_carry_the_shape_and_the_errors_are_as_stated() {
        let (sigma, sigma_tangent) = (5e-5, 1e-3);
        let (mut square, mut ratio, mut many) = (0.0, 0.0, 0.0);
        for seed in 0..40 {
            let bins = circle(120, sigma, sigma_tangent, seed);
            for (bin, (at, covariance)) in bins.iter().zip(smooth(&bins, true)) {
                let normal = Vector2::new(-bin.tangent.y, bin.tangent.x);
                let error = offset(&at);
                square += error * error;
                ratio += error * error / normal.dot(&(covariance * normal));
                many += 1.0;
            }
        }
        let rms = f64::sqrt(square / many);
        println!("bins 50 um, smoothed {:.2} um, error over what is stated {:.2}", rms * 1e6, f64::sqrt(ratio / many));
        assert!(rms < sigma / 5.0 && (ratio / many - 1.0).abs() < 0.5);
    }

    #[test]
    fn without_tangents_a_bin_keeps_to_itself() {
        let bins = circle(20, 5e-5, 1e-3, 1);
        for (bin, (at, covariance)) in bins.iter().zip(smooth(&bins, false)) {
            assert!((at - bin.at).norm() < 1e-15 && (covariance - bin.covariance).norm() < 1e-20);
        }
        assert!(smooth(&[], true).is_empty());
    }

    #[test]
    fn a_vertex_is_not_left() {
        // Stands still while the tangent turns by a right angle, between two edges.
        let mut random = Random::new(5);
        let sigma = 5e-5;
        let bins: Vec<PointBin> = (0..300)
            .map(|k| {
                let turned = (f64::from(k - 100) / 100.0).clamp(0.0, 1.0) * std::f64::consts::FRAC_PI_2;
                let true_at = Vector2::new(f64::from(k.min(100) - 100), f64::from((k - 200).max(0))) * 2e-4;
                let at = true_at + Vector2::new(random.normal(), random.normal()) * sigma;
                let tangent = Vector2::new(turned.cos(), turned.sin());
                let (from, to) = (k as usize, k as usize + 1);
                PointBin {
                    from,
                    to,
                    at,
                    covariance: Matrix2::identity() * sigma * sigma,
                    bias: 0.0,
                    tangent,
                    sigma_tangent: 1e-3,
                }
            })
            .collect();
        let estimates = smooth(&bins, true);
        for (at, covariance) in &estimates[100..=200] {
            assert!(squared_distance(at, covariance) < 25.0, "{at:?}");
        }
        let mean = estimates[120..180].iter().map(|(at, _)| at.norm_squared()).sum::<f64>() / 60.0;
        assert!(mean.sqrt() < sigma, "{mean}");
        assert!(estimates[50].0.y.abs() < 2e-5 && estimates[250].0.x.abs() < 2e-5);
    }
}
