//! The mean of a scan there and back, which is nearly without friction.

use crate::scan::passes;
use rod_core::{Reactions, Rod, Sample};
use std::ops::Range;

/// Largest distance of the pose back from that there, in lengths of the rod, or in means of the spacing of the samples if that is more.
const APART: f64 = 1e-3;
const SPACINGS: f64 = 2.0;
/// How far beyond the pass back a pose may be, in parts of the spacing: rounding.
const ROUNDING: f64 = 1e-6;

/// The mean of two passes of a recording along one path.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The samples of the pass there.
    pub there: Range<usize>,
    /// The samples of the pass back.
    pub back: Range<usize>,
    /// The mean at the poses of the pass there, where there is one back beside it.
    pub mean: Vec<Sample>,
    /// For each of them half of the difference of the reactions: nearly what friction does.
    pub half_difference: Vec<Reactions>,
}

/// The means of each pass of a recording and the next one, where that goes back along the same path.
///
/// Friction turns all forces one way on the way there, and the other way on the way back, so that the mean of the reactions at one pose is
/// without friction but for terms of the order of mu^2. On O1 of Merker et al. (2020) at q = 0.4 and x0 = 0 the error of f0x falls from 0.52
/// EI/L^2 to 0.014 with mu = 0.1, and from 1.50 to 0.12 with mu = 0.3. The mean is not that of one equilibrium where the
/// contacts there and back are different: beside transitions, behind snaps and within some 0.01 lengths of the rod of the turn, where
/// contacts stick.
///
/// Poses back are interpolated linearly between samples, which errs by an eighth of the second derivative times the square of the spacing.
///
/// ```
/// use rod_core::{Pose, Reactions, Rod, Sample};
/// use rod_reconstruct::without_friction;
/// let rod = Rod::new(0.1, 6.3e-4)?;
/// // forth by 50 mm and back, with a force that friction raises by 0.01 N on the way there
/// let sample = |k: i32| {
///     let x = 1e-4 * f64::from(500 - (k - 500).abs());
///     let f0y = 2.0 * x + if k < 500 { 0.01 } else { -0.01 };
///     Sample::new(Pose { x, y: 0.0, phi: 1.5 }, Reactions { f0x: 0.0, f0y, m0z: 0.0 })
/// };
/// let samples: Vec<Sample> = (0..1000).map(sample).collect();
/// let pairs = without_friction(&rod, &samples);
/// let one = &pairs[0];
/// assert!(pairs.len() == 1 && one.mean.len() > 490);
/// assert!(one.mean.iter().all(|mean| (mean.reactions.f0y - 2.0 * mean.pose.x).abs() < 1e-12));
/// assert!((one.half_difference[0].f0y - 0.01).abs() < 1e-12);
/// # Ok::<(), rod_core::RodError>(())
/// ```
pub fn without_friction(rod: &Rod, samples: &[Sample]) -> Vec<Pair> {
    let passes = passes(rod, samples);
    let pairs = passes.chunks_exact(2).map(|two| (two[0].clone(), two[1].clone()));
    pairs.filter_map(|(there, back)| pair(rod, samples, there, back)).collect()
}

fn pair(rod: &Rod, samples: &[Sample], there: Range<usize>, back: Range<usize>) -> Option<Pair> {
    let of = |range: &Range<usize>| -> Vec<Sample> {
        let part = samples.get(range.clone()).unwrap_or_default();
        part.iter().filter(|sample| is_finite(sample)).copied().collect()
    };
    let (forth, mut other) = (of(&there), of(&back));
    other.reverse();
    let spacing = other.windows(2).map(|two| distance(rod, &two[0], &two[1])).sum::<f64>() / other.len().max(1) as f64;
    let most = (APART * rod.length()).max(SPACINGS * spacing);
    let (mut mean, mut half_difference) = (Vec::new(), Vec::new());
    let mut next = 0;
    for sample in &forth {
        // both go along the same path: the place is never before that of the sample before
        while next + 2 < other.len() && share(rod, sample, &other[next], &other[next + 1]) > 1.0 {
            next += 1;
        }
        let (Some(a), Some(b)) = (other.get(next), other.get(next + 1)) else { break };
        let at = share(rod, sample, a, b);
        let between = |of: fn(&Reactions) -> f64| of(&a.reactions) * (1.0 - at) + of(&b.reactions) * at;
        let beside = |of: fn(&Sample) -> f64| of(a) * (1.0 - at) + of(b) * at - of(sample);
        let off = beside(|s| s.pose.x).hypot(beside(|s| s.pose.y)).hypot(rod.length() * beside(|s| s.pose.phi));
        if off > most || !(-ROUNDING..=1.0 + ROUNDING).contains(&at) {
            continue;
        }
        let r = sample.reactions;
        let [x, y, m] = [between(|r| r.f0x), between(|r| r.f0y), between(|r| r.m0z)];
        let both = |sign: f64| Reactions {
            f0x: 0.5 * (r.f0x + sign * x),
            f0y: 0.5 * (r.f0y + sign * y),
            m0z: 0.5 * (r.m0z + sign * m),
        };
        mean.push(Sample { reactions: both(1.0), ..*sample });
        half_difference.push(both(-1.0));
    }
    (!mean.is_empty()).then_some(Pair { there, back, mean, half_difference })
}

/// Where a sample is between two others: 0 at the first, 1 at the second.
fn share(rod: &Rod, sample: &Sample, a: &Sample, b: &Sample) -> f64 {
    let place = |s: &Sample| [s.pose.x, s.pose.y, rod.length() * s.pose.phi];
    let (p, a, b) = (place(sample), place(a), place(b));
    let (mut along, mut square) = (0.0, 0.0);
    for i in 0..3 {
        along += (p[i] - a[i]) * (b[i] - a[i]);
        square += (b[i] - a[i]).powi(2);
    }
    if square > 0.0 { along / square } else { 2.0 }
}

fn distance(rod: &Rod, a: &Sample, b: &Sample) -> f64 {
    (a.pose.x - b.pose.x).hypot(a.pose.y - b.pose.y).hypot(rod.length() * (a.pose.phi - b.pose.phi))
}

fn is_finite(sample: &Sample) -> bool {
    let (pose, r) = (sample.pose, sample.reactions);
    [pose.x, pose.y, pose.phi, r.f0x, r.f0y, r.m0z].iter().all(|v| v.is_finite())
}
