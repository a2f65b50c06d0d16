//! The offsets of the contours of several scans.

use super::nearest::{nearest, sampled};
use crate::contour::{ContourEstimate, TraceKind};
use nalgebra::{DMatrix, DVector};

/// Fewest places of a trace that are compared.
const PLACES: f64 = 200.0;
/// Most rounds of searching the nearest places again: each reduces an offset by a factor of about ten.
const ROUNDS: usize = 12;
/// Distances beyond this multiple of their median have less weight: places where the contours differ. Smaller: fewer places count, and
/// the offsets are noisier.
const OUTLYING: f64 = 3.0;

/// How far a scan must be moved to lie on the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Along the direction asked for, m.
    pub value: f64,
    /// Number of the group of scans that overlap, from 0: offsets are known against those of the same group only, whose
    /// mean offset is 0.
    pub group: usize,
}

impl Offset {
    /// The contour moved by it along `direction` (radians).
    pub fn applied(&self, contour: &ContourEstimate, direction: f64) -> ContourEstimate {
        let (sin, cos) = direction.sin_cos();
        let (dx, dy) = (self.value * cos, self.value * sin);
        let mut moved = contour.clone();
        for point in moved.traces.iter_mut().flat_map(|trace| &mut trace.points) {
            point.x += dx;
            point.y += dy;
        }
        for end in moved.gaps.iter_mut().flat_map(|gap| [&mut gap.from, &mut gap.to]).flatten() {
            *end = [end[0] + dx, end[1] + dy];
        }
        moved
    }
}

/// Offsets of scans along `direction` (radians; pi / 2: vertical), by least squares of the distances across the contour
/// where traces of single contacts overlap. Places that stand out, as those in concave parts do where the contours are
/// naive, count less.
///
/// Poses of scans that were recorded in one frame need none of this. Scans to which none other overlaps keep their
/// place.
///
/// ```
/// use rod_reconstruct::{ContourEstimate, Trace, TraceKind, TracePoint, align};
/// let scan = |up: f64| {
///     let points = (-50..=50).map(|k| 1e-4 * f64::from(k)).map(|x| {
///         TracePoint { x, y: 50.0 * x * x + up, alpha: (100.0 * x).atan(), sigma: 1e-5, systematic: 0.0 }
///     });
///     let trace = Trace { kind: TraceKind::Single, samples: 0..101, reversed: false, points: points.collect() };
///     ContourEstimate { traces: vec![trace], gaps: Vec::new() }
/// };
/// let offsets = align(&[scan(0.0), scan(4e-4)], std::f64::consts::FRAC_PI_2);
/// assert!((offsets[0].value - 2e-4).abs() < 1e-6 && (offsets[1].value + 2e-4).abs() < 1e-6);
/// ```
pub fn align(scans: &[ContourEstimate], direction: f64) -> Vec<Offset> {
    let count = scans.len();
    let mut offsets = vec![0.0; count];
    let mut groups: Vec<usize> = (0..count).collect();
    for _ in 0..ROUNDS {
        let moved: Vec<_> = scans
            .iter()
            .zip(&offsets)
            .map(|(scan, &value)| Offset { value, group: 0 }.applied(scan, direction))
            .collect();
        let pairs = pairs(&moved, direction);
        groups = grouped(count, &pairs);
        let Some(change) = change(count, &pairs, &groups) else { break };
        offsets.iter_mut().zip(&change).for_each(|(offset, change)| *offset += change);
        if change.iter().all(|change| change.abs() < 1e-12) {
            break;
        }
    }
    let mean = |group: usize| {
        let members = groups.iter().zip(&offsets).filter(|&(&of, _)| of == group);
        members.clone().map(|(_, offset)| offset).sum::<f64>() / members.count() as f64
    };
    offsets.iter().zip(&groups).map(|(value, &group)| Offset { value: value - mean(group), group }).collect()
}

/// A place of one scan beside one of another.
struct Pair {
    scans: (usize, usize),
    /// How far the first is outside the second.
    outside: f64,
    /// How that changes with the offset of the first.
    rate: f64,
    sigma: f64,
}

fn pairs(scans: &[ContourEstimate], direction: f64) -> Vec<Pair> {
    let mut pairs = Vec::new();
    let single = |scan: usize| scans[scan].of_kind(TraceKind::Single);
    for a in 0..scans.len() {
        for b in (0..scans.len()).filter(|&b| b != a) {
            for trace in single(a) {
                for place in sampled(&trace.points, trace.length() / PLACES) {
                    let near = single(b).filter_map(|other| nearest(&other.points, place.x, place.y));
                    let near = near.min_by(|p, q| p.distance.total_cmp(&q.distance)).filter(|near| near.interior);
                    let Some(near) = near else { continue };
                    // Opposite sides of a thin object are not the same place.
                    if (near.point.alpha - place.alpha).cos() <= 0.5 {
                        continue;
                    }
                    let (sin, cos) = near.point.alpha.sin_cos();
                    let outside = (place.x - near.point.x) * sin - (place.y - near.point.y) * cos;
                    let rate = (near.point.alpha - direction).sin();
                    pairs.push(Pair { scans: (a, b), outside, rate, sigma: place.sigma.hypot(near.point.sigma) });
                }
            }
        }
    }
    pairs.retain(|pair| pair.outside.is_finite() && pair.sigma.is_finite());
    pairs
}

/// For each scan the least number of those it overlaps with, directly or through others, renumbered from 0.
fn grouped(count: usize, pairs: &[Pair]) -> Vec<usize> {
    let mut group: Vec<usize> = (0..count).collect();
    for pair in pairs {
        let (a, b) = (group[pair.scans.0], group[pair.scans.1]);
        if a != b {
            group.iter_mut().filter(|group| **group == a.max(b)).for_each(|group| *group = a.min(b));
        }
    }
    let mut names = group.clone();
    names.sort_unstable();
    names.dedup();
    group.iter().map(|group| names.partition_point(|name| name < group)).collect()
}

/// The offsets that fit the pairs best, those of each group with mean 0.
fn change(count: usize, pairs: &[Pair], groups: &[usize]) -> Option<Vec<f64>> {
    if pairs.is_empty() {
        return None;
    }
    let middle = |mut values: Vec<f64>| {
        let half = values.len() / 2;
        *values.select_nth_unstable_by(half, f64::total_cmp).1
    };
    // limits the weight of a single place
    let floor = middle(pairs.iter().map(|pair| pair.sigma).collect()).max(1e-9);
    let mut solution = DVector::zeros(count);
    for _ in 0..20 {
        let residual = |pair: &Pair, solution: &DVector<f64>| {
            pair.outside + pair.rate * (solution[pair.scans.0] - solution[pair.scans.1])
        };
        let relative = |pair: &Pair, solution: &DVector<f64>| residual(pair, solution).abs() / pair.sigma.max(floor);
        let scale = middle(pairs.iter().map(|pair| relative(pair, &solution)).collect()).max(1e-6);
        let mut matrix = DMatrix::zeros(count, count);
        let mut right = DVector::zeros(count);
        for pair in pairs {
            let relative = relative(pair, &solution) / (OUTLYING * scale);
            // Tukey's biweight would give no weight at all where offsets are large; this weight only decreases
            let weight = 1.0 / ((1.0 + relative.powi(4)) * pair.sigma.max(floor).powi(2));
            let (a, b) = pair.scans;
            let rates = [(a, pair.rate), (b, -pair.rate)];
            for (i, p) in rates {
                right[i] -= weight * p * pair.outside;
                for (j, q) in rates {
                    matrix[(i, j)] += weight * p * q;
                }
            }
        }
        // makes the mean of each group 0
        let size = (0..count).map(|k| matrix[(k, k)]).fold(f64::MIN_POSITIVE, f64::max);
        for (i, of_i) in groups.iter().enumerate() {
            for (j, of_j) in groups.iter().enumerate() {
                if of_i == of_j {
                    matrix[(i, j)] += size;
                }
            }
        }
        let next = matrix.lu().solve(&right)?;
        let moved = (&next - &solution).amax();
        solution = next;
        if moved < 1e-13 || moved.is_nan() {
            break;
        }
    }
    solution.iter().all(|value| value.is_finite()).then(|| solution.iter().copied().collect())
}
