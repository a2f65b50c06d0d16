//! The offsets of the contours of several scans.

use super::nearest::{nearest, resample};
use crate::contour::{ContourEstimate, TraceKind};
use crate::least_squares::{Loss, NormalMatrix, Problem, Status, WholeSteps, iterate};
use crate::numeric::median;
use nalgebra::DVector;

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
        groups = connected_groups(count, &pairs);
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
struct ScanPair {
    scans: (usize, usize),
    /// How far the first is outside the second.
    outside: f64,
    /// How that changes with the offset of the first.
    rate: f64,
    sigma: f64,
}

fn pairs(scans: &[ContourEstimate], direction: f64) -> Vec<ScanPair> {
    let mut pairs = Vec::new();
    let single = |scan: usize| scans[scan].of_kind(TraceKind::Single);
    for a in 0..scans.len() {
        for b in (0..scans.len()).filter(|&b| b != a) {
            for trace in single(a) {
                for place in resample(&trace.points, trace.length() / PLACES) {
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
                    pairs.push(ScanPair { scans: (a, b), outside, rate, sigma: place.sigma.hypot(near.point.sigma) });
                }
            }
        }
    }
    pairs.retain(|pair| pair.outside.is_finite() && pair.sigma.is_finite());
    pairs
}

/// For each scan the least number of those it overlaps with, directly or through others, renumbered from 0.
fn connected_groups(count: usize, pairs: &[ScanPair]) -> Vec<usize> {
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

/// Most steps to the offsets of given pairs, and the change of an offset (m) below which they are found.
const STEPS: usize = 20;
const SMALL: f64 = 1e-13;

/// Offsets as a least-squares problem: pairs with a robust loss whose scale is their median residual, and for each group the condition that
/// its mean is 0, without which offsets are known up to a constant.
struct Alignment<'a> {
    pairs: &'a [ScanPair],
    groups: &'a [usize],
    /// Smallest standard deviation of a pair: limits the weight of a single place.
    floor: f64,
}

impl Problem for Alignment<'_> {
    type Equations = NormalMatrix;

    fn equations(&mut self, offsets: &DVector<f64>) -> NormalMatrix {
        let residual = |pair: &ScanPair| pair.outside + pair.rate * (offsets[pair.scans.0] - offsets[pair.scans.1]);
        let relative = |pair: &ScanPair| residual(pair).abs() / pair.sigma.max(self.floor);
        let loss = Loss::Quartic(OUTLYING * upper_median(self.pairs.iter().map(relative)).max(1e-6));
        let mut normal = NormalMatrix::empty(offsets.len());
        for pair in self.pairs {
            let (row, sigma) = ([(pair.scans.0, pair.rate), (pair.scans.1, -pair.rate)], pair.sigma.max(self.floor));
            normal.add_weighted(&row, residual(pair), loss.weight(sigma.powi(-2), relative(pair)));
        }
        let size = normal.matrix.diagonal().iter().fold(f64::MIN_POSITIVE, |a, b| a.max(*b));
        for group in 0..self.groups.iter().max().map_or(0, |last| last + 1) {
            let members: Vec<(usize, f64)> =
                (0..self.groups.len()).filter(|scan| self.groups[*scan] == group).map(|scan| (scan, 1.0)).collect();
            let sum = members.iter().map(|(scan, _)| offsets[*scan]).sum();
            normal.add_weighted(&members, sum, size);
        }
        normal
    }
}

/// The upper one of an even number.
fn upper_median(values: impl Iterator<Item = f64>) -> f64 {
    median(values.collect()).unwrap_or(0.0)
}

/// The offsets that fit the pairs best, those of each group with mean 0.
fn change(count: usize, pairs: &[ScanPair], groups: &[usize]) -> Option<Vec<f64>> {
    if pairs.is_empty() {
        return None;
    }
    let floor = upper_median(pairs.iter().map(|pair| pair.sigma)).max(1e-9);
    let mut problem = Alignment { pairs, groups, floor };
    let (at, status) = iterate(&mut problem, DVector::zeros(count), WholeSteps::until(SMALL), STEPS);
    let is_found = status != Status::Stalled && at.x.iter().all(|value| value.is_finite());
    is_found.then(|| at.x.iter().copied().collect())
}
