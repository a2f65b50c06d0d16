//! Where A and B meet: the one transition at which the reactions hardly break.

use super::evidence::Evidence;
use crate::point::clamp::Clamp;
use crate::scan::local_cubic::Noise;
use crate::scan::track::Track;
use nalgebra::{Matrix2, Vector2, Vector3};
use std::ops::Range;

/// Most means of neighbouring samples that a border is looked for among.
const MEANS: usize = 400;

/// The first sample of the phase after, in a range where A (`tip_first`) goes over into B, or B into A. The criterion K
/// leaves 0 on the side of A, the arc length of the moment zero leaves the tip on the side of B, both gradually: least
/// squares with a parabola through the border on each side.
pub(super) fn border(track: &Track, noise: &Noise, range: Range<usize>, tip_first: bool) -> usize {
    let count = range.len().div_ceil(MEANS).max(1);
    let spread = noise.variance.component_mul(&noise.long_run) / count as f64;
    let means: Vec<Mean> = range
        .clone()
        .step_by(count)
        .map(|from| {
            let part = from..(from + count).min(range.end);
            Mean::new(track, part, if count == 1 { &noise.variance } else { &spread })
        })
        .collect();
    let mut best = (f64::NEG_INFINITY, range.start);
    for border in 0..=means.len() {
        let origin = means.get(border).map_or(track.tau[range.end - 1], |mean| mean.from);
        let (before, after) = means.split_at(border);
        let (tip, flank) = if tip_first { (before, after) } else { (after, before) };
        let gain = Parabola::through(origin, tip.iter().map(|mean| (mean.tau, mean.criterion)))
            + Parabola::through(origin, flank.iter().map(|mean| (mean.tau, mean.length)));
        if gain > best.0 {
            best = (gain, (range.start + border * count).min(range.end));
        }
    }
    best.1
}

/// The mean of neighbouring samples: the criterion and the arc length beyond the tip, each with its weight.
struct Mean {
    from: f64,
    tau: f64,
    criterion: (f64, f64),
    length: (f64, f64),
}

impl Mean {
    fn new(track: &Track, part: Range<usize>, variance: &Vector3<f64>) -> Self {
        let count = part.len() as f64;
        let sum = track.clamps[part.clone()]
            .iter()
            .fold((Vector3::zeros(), Vector3::zeros()), |sum, clamp| (sum.0 + clamp.pose, sum.1 + clamp.reactions));
        let clamp = Clamp { pose: sum.0 / count, reactions: sum.1 / count };
        let evidence = Evidence::of_sample(&clamp, variance);
        let weighted = |value: f64, sigma: f64| if value.is_finite() { (value, sigma.powi(-2)) } else { (0.0, 0.0) };
        Self {
            from: track.tau[part.start],
            tau: track.tau[part.clone()].iter().sum::<f64>() / count,
            criterion: weighted(evidence.criterion.value, evidence.criterion.sigma),
            length: weighted(evidence.length.value, evidence.length.sigma),
        }
    }
}

/// Normal equations of c x + d x^2.
#[derive(Default)]
struct Parabola {
    normal: Matrix2<f64>,
    right: Vector2<f64>,
}

impl Parabola {
    /// By how much the weighted sum of squares falls with a parabola through 0 at the origin.
    fn through(origin: f64, values: impl Iterator<Item = (f64, (f64, f64))>) -> f64 {
        let mut sums = Self::default();
        for (tau, (value, weight)) in values {
            let x = tau - origin;
            let basis = Vector2::new(x, x * x);
            sums.normal += basis * basis.transpose() * weight;
            sums.right += basis * (weight * value);
        }
        let line = sums.right.x * sums.right.x / sums.normal[(0, 0)];
        let gain = sums.normal.cholesky().map_or(line, |normal| sums.right.dot(&normal.solve(&sums.right)));
        if gain.is_finite() { gain } else { 0.0 }
    }
}
