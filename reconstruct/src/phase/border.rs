//! The border between A and B, the one transition at which the reactions hardly break.

use super::evidence::Evidence;
use crate::numeric::NormalEquations;
use crate::point::{Clamp, Inverse};
use crate::scan::{Noise, Track};
use nalgebra::{Vector1, Vector2, Vector3};
use std::ops::Range;

/// Most means of neighbouring samples among which a border is searched. The work grows with the square.
const MEANS: usize = 400;

/// The first sample after the border, in a range in which A is followed by B (`tip_first`), or B by A.
///
/// The criterion K leaves 0 on the side of A, and the arc length of the moment zero leaves the tip on the side of B, both gradually.
/// On each side a parabola that vanishes at the border is fitted; the border is where the two fit best.
pub(super) fn border<I: Inverse>(rod: &I, track: &Track, noise: &Noise, range: Range<usize>, tip_first: bool) -> usize {
    let count = range.len().div_ceil(MEANS).max(1);
    let spread = noise.variance.component_mul(&noise.long_run) / count as f64;
    let means: Vec<Mean> = range
        .clone()
        .step_by(count)
        .map(|from| {
            let part = from..(from + count).min(range.end);
            Mean::new(rod, track, part, if count == 1 { &noise.variance } else { &spread })
        })
        .collect();
    let mut best = (f64::NEG_INFINITY, range.start);
    for border in 0..=means.len() {
        let origin = means.get(border).map_or(track.tau[range.end - 1], |mean| mean.from);
        let (before, after) = means.split_at(border);
        let (tip, side) = if tip_first { (before, after) } else { (after, before) };
        let both = gain(origin, tip.iter().map(|mean| (mean.tau, mean.criterion)))
            + gain(origin, side.iter().map(|mean| (mean.tau, mean.length)));
        if both > best.0 {
            best = (both, (range.start + border * count).min(range.end));
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
    fn new<I: Inverse>(rod: &I, track: &Track, part: Range<usize>, variance: &Vector3<f64>) -> Self {
        let count = part.len() as f64;
        let sum = track.clamps[part.clone()]
            .iter()
            .fold((Vector3::zeros(), Vector3::zeros()), |sum, clamp| (sum.0 + clamp.pose, sum.1 + clamp.reactions));
        let Track { natural, friction, .. } = *track;
        let clamp = Clamp { pose: sum.0 / count, reactions: sum.1 / count, natural, friction };
        let evidence = Evidence::of_sample(rod, &clamp, variance);
        let weighted = |value: f64, sigma: f64| if value.is_finite() { (value, sigma.powi(-2)) } else { (0.0, 0.0) };
        Self {
            from: track.tau[part.start],
            tau: track.tau[part.clone()].iter().sum::<f64>() / count,
            criterion: weighted(evidence.criterion.value, evidence.criterion.sigma),
            length: weighted(evidence.length.value, evidence.length.sigma),
        }
    }
}

/// By how much the weighted sum of squares falls with a parabola c x + d x^2 through 0 at the origin; `values` are the path
/// parameters, the values and their weights.
fn gain(origin: f64, values: impl Iterator<Item = (f64, (f64, f64))>) -> f64 {
    let mut equations = NormalEquations::<2, 1>::default();
    for (tau, (value, weight)) in values {
        let x = tau - origin;
        equations.add(&Vector2::new(x, x * x), &Vector1::new(value), weight);
    }
    let line = equations.right.x * equations.right.x / equations.square(0);
    let gain = equations.factor().map_or(line, |normal| equations.right.dot(&normal.solve(&equations.right)));
    if gain.is_finite() { gain } else { 0.0 }
}
