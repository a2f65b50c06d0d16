//! The passes of a recording whose clamp turns back.

use super::FEWEST_SAMPLES;
use rod_core::{Rod, Sample};
use std::ops::Range;

/// Length of the chords by which the direction of the clamp is told, rod lengths. Larger: passes that are shorter than it are not
/// seen. Smaller: a clamp that trembles this much seems to turn back.
const CHORD: f64 = 0.02;
/// Chords are no longer than this share of the length of all movements, so that short scans have several.
const SHARE: f64 = 0.05;
/// Chords are at least this many standard deviations of the pose. Smaller: noise of the pose splits a pass.
const SIGMAS: f64 = 12.0;
/// Cosine of the angle between a chord and the mean of the last chords of its pass below which a new pass begins. Larger: a path
/// that bends within a few chords is split.
const CORNER: f64 = 0.3;
/// Factor on the weight of earlier chords in the direction of a pass. At 0.5 about two chords count.
const KEPT: f64 = 0.5;

/// The passes of a recording: parts in which the clamp moves in one direction, in order and without gaps.
///
/// A pass ends where the clamp turns back, or turns by more than 70 degrees within a few hundredths of the rod's length. Noise of
/// the poses and short steps back do not end it. A part with fewer than [`FEWEST_SAMPLES`] samples belongs to the pass
/// before it. Samples that are not finite belong to the pass around them.
///
/// ```
/// use rod_core::{Pose, Reactions, Rod};
/// use rod_reconstruct::{Sample, passes};
/// let rod = Rod::new(0.1, 6.3e-4)?;
/// // forth by 50 mm and back
/// let at = |x| Sample::new(Pose { x, y: 0.0, phi: 1.5 }, Reactions::default());
/// let samples: Vec<Sample> = (0..1000).map(|k: i32| at(1e-4 * f64::from(500 - (k - 500).abs()))).collect();
/// assert_eq!(passes(&rod, &samples), [0..500, 500..1000]);
/// assert_eq!(passes(&rod, &samples[..400]), [0..400]);
/// # Ok::<(), rod_core::RodError>(())
/// ```
pub fn passes(rod: &Rod, samples: &[Sample]) -> Vec<Range<usize>> {
    let poses: Vec<(usize, [f64; 3])> = samples
        .iter()
        .enumerate()
        .map(|(k, sample)| (k, [sample.pose.x, sample.pose.y, rod.length() * sample.pose.phi]))
        .filter(|(_, pose)| pose.iter().all(|v| v.is_finite()))
        .collect();
    let borders = turns(&poses, rod.length());
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut start = 0;
    for end in borders.into_iter().chain([samples.len()]) {
        match found.last_mut() {
            Some(before) if end - start < FEWEST_SAMPLES || before.len() < FEWEST_SAMPLES => before.end = end,
            _ if end > start => found.push(start..end),
            _ => {}
        }
        start = end;
    }
    found
}

/// The first samples after each turn. `poses` are those of the finite samples, (x, y, L phi), m, with the numbers of the samples.
fn turns(poses: &[(usize, [f64; 3])], length: f64) -> Vec<usize> {
    let chord = chord(poses, length);
    let mut borders = Vec::new();
    let Some(first) = poses.first() else { return borders };
    // positions in `poses` of the last vertex, of the one before and of the last turn
    let (mut last, mut before, mut turned) = (0, 0, 0);
    let (mut vertex, mut direction) = (first.1, [0.0; 3]);
    for k in 1..poses.len() {
        let step = minus(&poses[k].1, &vertex);
        let norm = dot(&step, &step).sqrt();
        if norm < chord || norm == 0.0 {
            continue;
        }
        let unit = step.map(|v| v / norm);
        let size = dot(&direction, &direction).sqrt();
        if size > 0.0 && dot(&unit, &direction) < CORNER * size {
            // the sample that is farthest in the old direction, and least in the new one
            let bend: [f64; 3] = std::array::from_fn(|i| direction[i] / size - unit[i]);
            let far = |j: &usize| dot(&poses[*j].1, &bend);
            let since = before.max(turned + 1).min(last)..k;
            turned = since.max_by(|i, j| far(i).total_cmp(&far(j))).unwrap_or(last);
            borders.push(poses[turned].0);
            direction = unit;
        } else {
            direction = std::array::from_fn(|i| KEPT * direction[i] + unit[i]);
        }
        (before, last, vertex) = (last, k, poses[k].1);
    }
    borders
}

/// The length of chords, m.
fn chord(poses: &[(usize, [f64; 3])], length: f64) -> f64 {
    let low: [f64; 3] = std::array::from_fn(|i| poses.iter().fold(f64::INFINITY, |m, p| m.min(p.1[i])));
    let high: [f64; 3] = std::array::from_fn(|i| poses.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.1[i])));
    let size = minus(&high, &low);
    let all = dot(&size, &size).sqrt();
    (CHORD * length).min(SHARE * all).max(SIGMAS * trembling(poses))
}

/// Standard deviation of the noise of a pose, m: the median of the second differences, which is 0 for a smooth movement.
pub(super) fn trembling(poses: &[(usize, [f64; 3])]) -> f64 {
    let mut bends: Vec<f64> = poses
        .windows(3)
        .map(|w| {
            let bend: [f64; 3] = std::array::from_fn(|i| w[0].1[i] - 2.0 * w[1].1[i] + w[2].1[i]);
            dot(&bend, &bend)
        })
        .collect();
    if bends.is_empty() {
        return 0.0;
    }
    let middle = bends.len() / 2;
    let (_, median, _) = bends.select_nth_unstable_by(middle, f64::total_cmp);
    // of one noisy coordinate: the median of a squared normal variable is 0.455, and a second difference has 6 times the variance
    (*median / (6.0 * 0.455)).sqrt()
}

fn minus(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;
    use rod_core::{Pose, Reactions};

    fn split(poses: impl IntoIterator<Item = [f64; 2]>, sigma: f64) -> Vec<Range<usize>> {
        let mut random = Random::new(1);
        let samples: Vec<Sample> = poses
            .into_iter()
            .map(|[x, y]| Sample::new(Pose { x: x + sigma * random.normal(), y, phi: 1.5 }, Reactions::default()))
            .collect();
        let found = passes(&Rod::new(0.1, 6e-4).unwrap(), &samples);
        assert!(found.windows(2).all(|w| w[0].end == w[1].start));
        assert_eq!((found[0].start, found[found.len() - 1].end), (0, samples.len()));
        found
    }

    #[test]
    fn a_raster_has_a_pass_for_each_line() {
        // lines of 50 mm, forth and back, 1 mm or 8 mm apart
        for shift in [10, 80] {
            let mut poses = Vec::new();
            for line in 0..6 {
                let y = 1e-4 * f64::from(shift * line);
                poses.extend((0..500).map(|k| [1e-4 * f64::from(if line % 2 == 0 { k } else { 500 - k }), y]));
                let end = if line % 2 == 0 { 0.05 } else { 0.0 };
                poses.extend((0..shift).map(|k| [end, y + 1e-4 * f64::from(k)]));
            }
            for sigma in [0.0, 5e-6] {
                let found = split(poses.iter().copied(), sigma);
                let long = found.iter().filter(|pass| pass.len() >= 450).count();
                assert!(long == 6 && (6..=12).contains(&found.len()), "{shift} {sigma}: {found:?}");
            }
        }
    }

    #[test]
    fn a_random_walk_has_passes_in_order() {
        let mut random = Random::new(5);
        let mut place = [0.0, 0.0];
        let walk: Vec<[f64; 2]> = (0..400_000)
            .map(|_| {
                place = place.map(|v| v + 1e-2 * random.normal());
                place
            })
            .collect();
        let found = split(walk, 0.0);
        assert!(found.len() > 2 && found.iter().all(|pass| pass.len() >= FEWEST_SAMPLES), "{}", found.len());
    }

    #[test]
    fn noise_short_steps_back_and_bends_are_no_turns() {
        let line = |k: i32| [2e-6 * f64::from(k), 0.0];
        assert_eq!(split((0..10_000).map(line), 5e-6).len(), 1);
        let back = |k: i32| [2e-6 * f64::from(if k % 1000 < 20 { k - 30 } else { k }), 0.0];
        assert_eq!(split((0..10_000).map(back), 0.0).len(), 1);
        let circle = |k: i32| [0.1 * (1e-3 * f64::from(k)).cos(), 0.1 * (1e-3 * f64::from(k)).sin()];
        assert_eq!(split((0..6000).map(circle), 0.0).len(), 1);
        assert_eq!(split((0..30).map(|_| [0.0, 0.0]), 0.0).len(), 1);
        assert_eq!(passes(&Rod::new(0.1, 6e-4).unwrap(), &[]), []);
    }
}
