//! The noise of a run of points, estimated from the points.
//!
//! Fourth differences of neighbours remove what changes smoothly and have 70 times the variance of white noise. Their median is not
//! affected by the few that span a vertex or a leap.

use super::measured::ContactPoint;
use crate::numeric::squared_distance;
use nalgebra::{Matrix2, Vector2};

/// Variance of a fourth difference over that of its terms: 1 + 16 + 36 + 16 + 1.
const GAIN: f64 = 70.0;
/// Median of the square of a plane standard normal vector, 2 ln 2.
const MEDIAN: f64 = 2.0 * std::f64::consts::LN_2;
/// Fewest differences for an estimate.
const FEWEST: usize = 8;
/// Smallest share of the trace of a covariance that each of its axes gets, so that it can be inverted.
const ROUNDEST: f64 = 1e-6;
/// Standard deviation of a position by rounding, in the points and in sums of them: in m, and relative to the size of the run.
const ROUNDING: (f64, f64) = (1e-14, 1e-10);

/// The variance of white noise in each coordinate, as a multiple of the covariance given for each vector (by its index); none for
/// too few vectors.
pub(super) fn variance(
    vectors: impl Iterator<Item = Vector2<f64>>,
    covariance: impl Fn(usize) -> Matrix2<f64>,
) -> Option<f64> {
    let mut last = [Vector2::zeros(); 4];
    let mut squares = Vec::new();
    for (index, vector) in vectors.enumerate() {
        let [a, b, c, d] = last;
        if index >= 4 {
            let difference = a - 4.0 * b + 6.0 * c - 4.0 * d + vector;
            squares.push(squared_distance(&difference, &covariance(index - 2)));
        }
        last = [b, c, d, vector];
    }
    if squares.len() < FEWEST {
        return None;
    }
    let middle = squares.len() / 2;
    let (_, median, _) = squares.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median / (MEDIAN * GAIN))
}

/// Gives each point of a run a covariance that can be inverted and is at least the scatter of the points. Where none is known it is
/// the scatter itself.
pub(super) fn complete(run: &mut [ContactPoint]) {
    let Some(first) = run.first() else { return };
    let extent = run.iter().map(|point| (point.at - first.at).norm()).fold(0.0, f64::max);
    let floor = ROUNDING.0 + ROUNDING.1 * (extent + first.at.norm());
    let unknown = |point: &ContactPoint| point.covariance.trace() <= 0.0;
    if run.iter().any(unknown) {
        let scatter = variance(run.iter().map(|point| point.at), |_| Matrix2::identity()).unwrap_or(0.0);
        for point in run.iter_mut().filter(|point| unknown(point)) {
            point.covariance = Matrix2::identity() * scatter;
        }
    }
    for point in run.iter_mut() {
        point.covariance += Matrix2::identity() * (0.5 * ROUNDEST * point.covariance.trace() + floor * floor);
    }
    let excess = variance(run.iter().map(|point| point.at), |index| run[index].covariance).unwrap_or(1.0);
    if excess > 1.0 && excess.is_finite() {
        run.iter_mut().for_each(|point| point.covariance *= excess);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;

    fn parabola(count: usize, sigma: f64, stated: f64) -> Vec<ContactPoint> {
        let mut random = Random::new(3);
        let point = |sample| {
            let x = sample as f64 * 2e-6;
            let at = Vector2::new(x + sigma * random.normal(), 50.0 * x * x + sigma * random.normal());
            ContactPoint {
                sample,
                at,
                force: Vector2::x(),
                tangent: Vector2::x(),
                s: f64::INFINITY,
                covariance: Matrix2::identity() * stated * stated,
                shared: 1.0,
            }
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn scatter_becomes_the_covariance_where_none_is_known() {
        let mut run = parabola(4000, 3e-4, 0.0);
        complete(&mut run);
        let sigma = run[100].covariance[(0, 0)].sqrt();
        assert!((sigma / 3e-4 - 1.0).abs() < 0.05, "{sigma:e}");
    }

    #[test]
    fn a_covariance_that_is_too_small_grows_and_a_large_one_stays() {
        let mut run = parabola(4000, 3e-4, 1e-4);
        complete(&mut run);
        assert!((run[7].covariance[(1, 1)].sqrt() / 3e-4 - 1.0).abs() < 0.05);
        let mut run = parabola(4000, 3e-4, 1e-3);
        complete(&mut run);
        assert!((run[7].covariance[(1, 1)].sqrt() / 1e-3 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn few_points_say_nothing() {
        let mut run = parabola(5, 3e-4, 0.0);
        complete(&mut run);
        assert!(run.iter().all(|point| point.covariance[(0, 0)] > 0.0 && point.covariance[(0, 0)] < 1e-22));
        complete(&mut []);
    }
}
