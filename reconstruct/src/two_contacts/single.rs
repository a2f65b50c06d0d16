//! The single contact beside a run with two contacts.

use super::bend::UNSURE;
use super::choice::{Beside, End};
use super::series::Series;
use crate::numeric::propagate_covariance;
use crate::point::{Clamp, Inverse, is_free};
use crate::scan::{Noise, Track};
use crate::systematic::Correction;
use nalgebra::{DVector, Matrix2x3, Matrix3, Vector2};
use std::ops::Range;

/// Samples of a neighbouring stretch from which its contact is computed, unless the run itself has more.
const BESIDE: usize = 200;

/// The part of the neighbouring stretch next to the run.
#[derive(Clone, Debug)]
pub(super) struct Single {
    series: Series,
    /// Path parameter at its end next to the run, and the path length of the clamp from there to the run.
    tau: f64,
    way: f64,
}

impl Single {
    /// The end of `range` on this side of a run whose outermost sample is at path parameter `edge`.
    pub fn beside(
        track: &Track,
        noise: &Noise,
        range: &Range<usize>,
        side: usize,
        like: usize,
        edge: f64,
    ) -> Option<Self> {
        let count = range.len().min(like.max(BESIDE));
        let range = if side == 0 { range.end - count..range.end } else { range.start..range.start + count };
        let tau = track.tau[if side == 0 { range.end - 1 } else { range.start }];
        let series = Series::through(track, range, noise)?;
        Some(Self { series, tau, way: (edge - tau).abs() })
    }

    /// The same with displaced samples.
    pub fn displaced(&self, by: &Correction) -> Self {
        Self { series: self.series.displaced(by), ..*self }
    }

    /// The contact at the end next to the run.
    pub fn contact<I: Inverse>(&self, rod: &I) -> Option<Beside> {
        let (series, way) = (&self.series, self.way);
        let t = series.interval.local(self.tau);
        let [clamp, _] = series.clamps(t);
        let p = DVector::from_vec(series.interval.basis(t, series.terms()).0);
        let covariance = Matrix3::from_diagonal(&(series.variance * p.dot(&(&series.inverse * &p))));
        let zero = |clamp: &Clamp| rod.first(clamp).ok().filter(|_| !is_free(clamp, &covariance));
        let found = zero(&clamp)?;
        let normal = found.normal();
        let by: Matrix2x3<f64> = found.by_reactions.fixed_rows::<2>(0).into_owned();
        let sigma = propagate_covariance(&(normal.transpose() * by), &covariance).x.sqrt();
        let sigma_s = propagate_covariance(&found.s_by_reactions.transpose(), &covariance).x.sqrt();
        let place = Vector2::new(found.section.x, found.section.y);
        // the other end of the neighbour's samples
        let far = zero(&series.clamps(-t)[0]);
        let bend = far.map_or(f64::INFINITY, |far| {
            let passed = (Vector2::new(far.section.x, far.section.y) - place).norm();
            let least = passed - UNSURE * (sigma_s * std::f64::consts::SQRT_2);
            let turned = far.normal().perp(&normal).abs();
            if least > 0.0 { turned / least } else { f64::INFINITY }
        });
        Some(Beside { last: End::Last { place, normal, sigma, way, bend }, s: found.s, sigma_s, way, bend })
    }
}
