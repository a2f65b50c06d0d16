//! Consecutive samples, averaged: linear relations between them remain, with less noise.

use crate::numeric::CHANCE;
use crate::scan::noise_estimate::estimate;
use nalgebra::Matrix3;
use rod_core::{Pose, Reactions, Sample};

/// Most bins of a recording. More: more time, and more noise of a bin.
const MOST_BINS: usize = 1000;
/// The rod is also free where all reactions are no more than this share of the largest: samples without noise that were corrected are not
/// exactly 0.
const NOTHING: f64 = 1e-6;

/// The mean of consecutive samples, SI units if theirs are.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReactionBin {
    pub pose: Pose,
    pub reactions: Reactions,
    /// 2 (f0y sin phi0 + f0x cos phi0), and 2 |F| sin rho with friction
    pub load: f64,
    /// Tangent of the angle of friction.
    pub friction: f64,
    /// m0z^2, less the variance of the noise.
    pub square: f64,
    /// Standard deviations of both.
    pub sigma_load: f64,
    pub sigma_square: f64,
    /// Covariance of the reactions.
    pub covariance: Matrix3<f64>,
}

/// The bins in which the rod is in contact. `friction` is the coefficient of each sample.
pub(super) fn bins(samples: &[Sample], friction: impl Fn(usize) -> f64) -> Vec<ReactionBin> {
    let usable: Vec<(usize, &Sample)> = samples.iter().enumerate().filter(|(_, sample)| is_finite(sample)).collect();
    let count: Vec<f64> = (0..usable.len()).map(|k| k as f64).collect();
    let channel = |of: fn(&Reactions) -> f64| -> Vec<f64> { usable.iter().map(|(_, s)| of(&s.reactions)).collect() };
    let channels = [channel(|r| r.f0x), channel(|r| r.f0y), channel(|r| r.m0z)];
    // spaced by number, not by path length, which may be in a wrong unit, too
    let noise = channels.each_ref().map(|channel| estimate(&count, channel));
    let nothing = channels.each_ref().map(|channel| channel.iter().fold(0.0_f64, |m, v| m.max(v.abs())) * NOTHING);
    let length = usable.len().div_ceil(MOST_BINS).max(1);
    let mut bins = Vec::with_capacity(usable.len() / length + 1);
    for part in usable.chunks(length) {
        let n = part.len() as f64;
        let mean = |of: &dyn Fn(&Sample) -> f64| part.iter().map(|(_, sample)| of(sample)).sum::<f64>() / n;
        let reactions = Reactions {
            f0x: mean(&|s| s.reactions.f0x),
            f0y: mean(&|s| s.reactions.f0y),
            m0z: mean(&|s| s.reactions.m0z),
        };
        let variance = [0, 1, 2].map(|c| {
            let long_run = if n > 1.0 { noise[c].long_run.max(1.0) } else { 1.0 };
            noise[c].sigma.powi(2) * long_run / n
        });
        let r = [reactions.f0x, reactions.f0y, reactions.m0z];
        if (0..3).all(|c| r[c].abs() <= CHANCE * variance[c].sqrt() + nothing[c]) {
            continue;
        }
        let friction = part.first().map_or(0.0, |(number, _)| friction(*number));
        let rubbing = 2.0 * reactions.f0x.hypot(reactions.f0y) * friction / friction.hypot(1.0);
        let pose = Pose { x: mean(&|s| s.pose.x), y: mean(&|s| s.pose.y), phi: mean(&|s| s.pose.phi) };
        bins.push(ReactionBin {
            pose,
            reactions,
            load: mean(&|s| load(s)) + rubbing,
            friction,
            square: mean(&|s| s.reactions.m0z.powi(2)) - noise[2].sigma.powi(2),
            sigma_load: 2.0 * variance[0].max(variance[1]).sqrt(),
            sigma_square: (4.0 * r[2].powi(2) * variance[2] + 2.0 * noise[2].sigma.powi(2) * variance[2]).sqrt(),
            covariance: Matrix3::from_diagonal(&variance.into()),
        });
    }
    bins
}

fn load(sample: &Sample) -> f64 {
    let (sin, cos) = sample.pose.phi.sin_cos();
    2.0 * (sample.reactions.f0y * sin + sample.reactions.f0x * cos)
}

fn is_finite(sample: &Sample) -> bool {
    let (pose, r) = (sample.pose, sample.reactions);
    [pose.x, pose.y, pose.phi, r.f0x, r.f0y, r.m0z].iter().all(|v| v.is_finite())
}
