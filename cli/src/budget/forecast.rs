//! How far each source of error displaces contact points, by derivatives.

use super::truth::PerfectSensor;
use nalgebra::{DMatrix, DVector};
use vibrissa::Rod;
use vibrissa::reconstruct::{Budget, Reconstruction, Source, influences};
use vibrissa::rod::Reactions;

/// Most contact points that the derivatives are computed at. More: more time.
const POINTS: usize = 2000;

/// Standard deviations across the contour, in the median over the single contacts, m.
#[derive(Clone, Debug)]
pub(crate) struct Forecast {
    pub sources: Vec<Share>,
    /// Of all sources, before any correction, and after the scan has calibrated itself.
    pub shared: [f64; 2],
    /// Of all sources after the scan has calibrated itself, if friction were known exactly; none where it is not a source.
    pub with_known_friction: Option<f64>,
    pub noise: f64,
    /// Displacements by one standard deviation of the budget of each source, a row for each point, m.
    pub(super) influence: DMatrix<f64>,
    /// Covariance of what is left of the errors, in standard deviations of the budget.
    pub(super) covariance: DMatrix<f64>,
}

/// One source of error alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    pub source: Source,
    /// Standard deviation, in the unit of the source: of the budget, and of what the scan leaves of it.
    pub sigma: [f64; 2],
    /// Displacement that it causes alone, m.
    pub displacement: [f64; 2],
}

impl Forecast {
    /// With the calibration and the noise of a reconstruction. None without single contacts.
    pub(super) fn of(
        rod: &Rod,
        truth: &PerfectSensor,
        budget: &Budget,
        sigma: Reactions,
        found: &Reconstruction,
    ) -> Option<Self> {
        let stride = truth.samples.len().div_ceil(POINTS).max(1);
        let sigma = [sigma.f0x, sigma.f0y, sigma.m0z];
        let friction = found.passes.iter().map(|pass| pass.used_friction).find(|mu| *mu != 0.0).unwrap_or(0.0);
        let points = influences(rod, &truth.samples, &truth.labels, sigma, friction, stride);
        let sources: Vec<Source> = Source::ALL.into_iter().filter(|source| budget.of(*source) > 0.0).collect();
        let influence = DMatrix::from_fn(points.len(), sources.len(), |point, k| {
            points[point].1.of(sources[k]) * budget.of(sources[k])
        });
        let count = sources.len();
        let calibration = found.calibration().filter(|calibration| {
            calibration.sources.iter().map(|estimate| estimate.source).eq(sources.iter().copied())
        });
        let covariance = calibration.map_or_else(
            || DMatrix::identity(count, count),
            |calibration| {
                let of = |i: usize, j: usize| budget.of(sources[i]) * budget.of(sources[j]);
                DMatrix::from_fn(count, count, |i, j| calibration.covariance[(i, j)] / of(i, j))
            },
        );
        let shares = (0..count)
            .map(|k| {
                let budget = budget.of(sources[k]);
                let left = covariance[(k, k)].max(0.0).sqrt();
                let before = median(influence.column(k).iter().map(|by| by.abs()))?;
                let (sigma, displacement) = ([budget, budget * left], [before, before * left]);
                Some(Share { source: sources[k], sigma, displacement })
            })
            .collect::<Option<Vec<Share>>>()?;
        let touches = found.readings.iter().filter(|reading| !reading.label.several());
        let touches = touches.filter_map(|reading| reading.touch.ok());
        let noise = median(
            touches.map(|touch| (touch.sigma_normal().powi(2) - touch.sigma_systematic().powi(2)).max(0.0).sqrt()),
        )?;
        let before = median_point_sigma(&influence, &DMatrix::identity(count, count))?;
        let after = median_point_sigma(&influence, &covariance)?;
        let with_known_friction = sources.iter().position(|source| *source == Source::Friction).and_then(|k| {
            let by = covariance.column(k);
            median_point_sigma(
                &influence,
                &(&covariance - by * by.transpose() / covariance[(k, k)].max(f64::MIN_POSITIVE)),
            )
        });
        Some(Self { sources: shares, shared: [before, after], with_known_friction, noise, influence, covariance })
    }

    /// The sources that displace points most after the calibration, the largest first.
    pub fn largest(&self, count: usize) -> Vec<Share> {
        let mut sources = self.sources.clone();
        sources.sort_by(|a, b| b.displacement[1].total_cmp(&a.displacement[1]));
        sources.truncate(count);
        sources
    }

    /// Of errors and noise together, after the scan has calibrated itself, m.
    pub fn total(&self) -> f64 {
        self.shared[1].hypot(self.noise)
    }
}

/// Median standard deviation of the points for errors of this covariance.
pub(super) fn median_point_sigma(influence: &DMatrix<f64>, covariance: &DMatrix<f64>) -> Option<f64> {
    let spread = influence * covariance;
    median((0..influence.nrows()).map(|point| {
        let square: DVector<f64> = spread.row(point).transpose().component_mul(&influence.row(point).transpose());
        square.sum().max(0.0).sqrt()
    }))
}

/// The upper median.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
