//! Intervals in which the contours of several scans disagree.

use super::nearest::{nearest, resample};
use crate::contour::{ContourEstimate, Trace};

/// Fewest places of a trace that are compared.
const PLACES: f64 = 400.0;

/// When contours of several scans disagree.
///
/// Points computed as if every sample had one contact agree between scans at different distances, except in the concave parts of an
/// object (Merker et al. 2020, section 3 and fig. 9). A comparison of [naive](crate::Assembly::naive) contours therefore finds
/// concave parts without identifying phases. A comparison of the traces of several contacts shows how accurate those are.
///
/// ```
/// use rod_reconstruct::{Comparison, ContourEstimate, Trace, TraceKind, TracePoint};
/// let scan = |deep: f64| {
///     let y = |x: f64| if x.abs() < 1e-3 { deep * (1.0 - 1e3 * x.abs()) } else { 0.0 };
///     let x = (-50..=50).map(|k| 1e-4 * f64::from(k));
///     let points = x.map(|x| TracePoint { x, y: y(x), alpha: 0.0, sigma: 1e-5, systematic: 0.0 }).collect();
///     let trace = Trace { kind: TraceKind::Single, samples: 0..101, reversed: false, points };
///     ContourEstimate { traces: vec![trace], gaps: Vec::new() }
/// };
/// let concave = Comparison::default().disagreements(&[scan(1e-3), scan(0.0)]);
/// assert_eq!(concave.len(), 1);
/// assert!(concave[0].from > -1.01e-3 && concave[0].to < 1.01e-3 && (concave[0].gap - 1e-3).abs() < 4e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The direction of the coordinate in which intervals are given, radians: 0 is x.
    pub direction: f64,
    /// Contours disagree where they are farther apart than this many standard deviations of their distance, plus `least`.
    pub significance: f64,
    /// Distance, m, that is allowed in any case: contours depart from the polygon of their points by as much.
    pub least: f64,
}

impl Default for Comparison {
    /// Along x; five standard deviations, and 20 um.
    fn default() -> Self {
        Self { direction: 0.0, significance: 5.0, least: 2e-5 }
    }
}

/// An interval in which contours disagree: a concave part of the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disagreement {
    /// Where it begins, m, as the coordinate along the direction of the comparison.
    pub from: f64,
    /// Where it ends, m.
    pub to: f64,
    /// The distance of the contours where it is most significant, m.
    pub gap: f64,
    /// Its standard deviation, m.
    pub sigma: f64,
}

impl Disagreement {
    /// How many standard deviations the contours are apart where they are most.
    pub fn significance(&self) -> f64 {
        self.gap / self.sigma
    }
}

impl Comparison {
    /// The intervals in which any two of the contours disagree, in order. Places that only one of the two followed are
    /// not compared. The order of the contours does not matter.
    pub fn disagreements(&self, scans: &[ContourEstimate]) -> Vec<Disagreement> {
        let mut found = Vec::new();
        for (k, scan) in scans.iter().enumerate() {
            for other in scans.iter().enumerate().filter(|&(j, _)| j != k).map(|(_, other)| other) {
                for trace in &scan.traces {
                    self.along(trace, other, &mut found);
                }
            }
        }
        unite_overlapping(found)
    }

    /// Adds the intervals in which a trace disagrees with a contour.
    fn along(&self, trace: &Trace, other: &ContourEstimate, found: &mut Vec<Disagreement>) {
        let (sin, cos) = self.direction.sin_cos();
        let mut open: Option<Disagreement> = None;
        for place in resample(&trace.points, trace.length() / PLACES) {
            let of_trace = |trace: &Trace| nearest(&trace.points, place.x, place.y);
            // where the end of a trace is the nearest place of all, the other scan was not here
            let near = other.traces.iter().filter_map(of_trace).min_by(|a, b| a.distance.total_cmp(&b.distance));
            let apart = near.filter(|near| near.interior).and_then(|near| {
                let sigma = place.sigma.hypot(near.point.sigma).max(f64::MIN_POSITIVE);
                let apart = near.distance > self.significance * sigma + self.least;
                apart.then_some((near, sigma))
            });
            let Some((near, sigma)) = apart else {
                found.extend(open.take());
                continue;
            };
            let along = |x: f64, y: f64| x * cos + y * sin;
            let (a, b) = (along(place.x, place.y), along(near.point.x, near.point.y));
            let here = Disagreement { from: a.min(b), to: a.max(b), gap: near.distance, sigma };
            open = Some(open.map_or(here, |open| union(&open, &here)));
        }
        found.extend(open);
    }
}

/// Both intervals in one.
fn union(a: &Disagreement, b: &Disagreement) -> Disagreement {
    let ordered = a.significance().total_cmp(&b.significance()).then(a.gap.total_cmp(&b.gap));
    let worst = if ordered.is_ge() { a } else { b };
    Disagreement { from: a.from.min(b.from), to: a.to.max(b.to), ..*worst }
}

/// Overlapping intervals made one, in order.
fn unite_overlapping(mut found: Vec<Disagreement>) -> Vec<Disagreement> {
    found.sort_by(|a, b| {
        let by = |f: fn(&Disagreement) -> f64| f(a).total_cmp(&f(b));
        by(|d| d.from).then(by(|d| d.to)).then(by(|d| d.gap)).then(by(|d| d.sigma))
    });
    let mut united: Vec<Disagreement> = Vec::new();
    for next in found {
        match united.last_mut() {
            Some(last) if next.from <= last.to => *last = union(last, &next),
            _ => united.push(next),
        }
    }
    united
}
