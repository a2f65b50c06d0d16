//! One contour from several scans.

use super::fuse::{fuse_traces, overlap};
use super::nearest::nearest;
use crate::contour::{ContourEstimate, Gap, Trace, TraceKind, TracePoint};
use std::cmp::Ordering;

/// One contour from several scans of one object, in one frame.
///
/// Traces that follow the same stretch become one. Where both passed, it is their mean weighted by the inverse variances, or the
/// more certain one if they disagree. Where only one passed, it is that one, so that a gap closes as far as any scan reached, for
/// example with the tip deep in a notch. Each kind of trace is merged on its own. Scans that do not overlap stay separate. A gap
/// of a scan remains if its ends still belong to different traces, and ends where these end. Offsets must have been
/// [applied](crate::Offset::applied) before.
///
/// The order of the scans does not matter, not even by rounding.
///
/// ```
/// use rod_reconstruct::{ContourEstimate, Trace, TraceKind, TracePoint, merge};
/// let scan = |from: i32, to: i32, y: f64, sigma: f64| {
///     let points = (from..=to).map(|k| TracePoint { x: 1e-3 * f64::from(k), y, alpha: 0.0, sigma, systematic: 0.0 }).collect();
///     let trace = Trace { kind: TraceKind::Single, samples: 0..9, reversed: false, points };
///     ContourEstimate { traces: vec![trace], gaps: Vec::new() }
/// };
/// let merged = merge(&[scan(0, 10, 0.0, 1e-5), scan(6, 20, 2e-5, 1e-5)]);
/// assert_eq!(merged.traces.len(), 1);
/// assert!((merged.traces[0].length() - 0.02).abs() < 1e-6);
/// let both = merged.traces[0].points.iter().find(|point| point.x > 7e-3).unwrap();
/// assert!((both.y - 1e-5).abs() < 1e-12 && (both.sigma - 1e-5 / 2_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn merge(scans: &[ContourEstimate]) -> ContourEstimate {
    let mut contour = ContourEstimate::default();
    for kind in [TraceKind::Single, TraceKind::First, TraceKind::Second] {
        let mut traces: Vec<&Trace> = scans.iter().flat_map(|scan| scan.of_kind(kind)).collect();
        traces.sort_by(|a, b| order(a, b));
        let mut merged: Vec<Trace> = Vec::new();
        for trace in traces.into_iter().filter(|trace| !trace.points.is_empty()) {
            let mut trace = trace.clone();
            while let Some(k) = merged.iter().position(|other| overlap(other, &trace)) {
                trace = fuse_traces(&merged.remove(k), &trace);
            }
            merged.push(trace);
        }
        merged.sort_by(order);
        contour.traces.extend(merged);
    }
    contour.gaps = left_open(scans, &contour.of_kind(TraceKind::Single).collect::<Vec<_>>());
    contour
}

/// The gaps of the scans that the merged traces leave open.
fn left_open(scans: &[ContourEstimate], single: &[&Trace]) -> Vec<Gap> {
    let mut gaps: Vec<&Gap> = scans.iter().flat_map(|scan| &scan.gaps).collect();
    gaps.sort_by(|a, b| {
        let ends = |gap: &Gap| [gap.from, gap.to].map(|end| end.unwrap_or([f64::INFINITY; 2]));
        let [a, b] = [(a, ends(a)), (b, ends(b))];
        lexical(a.1.as_flattened(), b.1.as_flattened())
            .then(a.0.reason.cmp(&b.0.reason))
            .then(a.0.samples.start.cmp(&b.0.samples.start))
            .then(a.0.samples.end.cmp(&b.0.samples.end))
    });
    let (mut known, mut open): (Vec<(usize, usize)>, Vec<Gap>) = (Vec::new(), Vec::new());
    for gap in gaps {
        let (Some(from), Some(to)) = (gap.from, gap.to) else { continue };
        let (Some(a), Some(b)) = (trace_of_end(single, from), trace_of_end(single, to)) else { continue };
        let pair = (a.min(b), a.max(b));
        if a == b || known.contains(&pair) {
            continue;
        }
        known.push(pair);
        let (from, to) = facing(single[pair.0], single[pair.1]);
        open.push(Gap { samples: gap.samples.clone(), from, to, reason: gap.reason.clone() });
    }
    open
}

/// The longest first; equal ones by their points.
fn order(a: &Trace, b: &Trace) -> Ordering {
    let numbers = |trace: &Trace| trace.points.iter().flat_map(|p| [p.x, p.y, p.alpha, p.sigma]).collect::<Vec<_>>();
    b.length()
        .total_cmp(&a.length())
        .then_with(|| lexical(&numbers(a), &numbers(b)))
        .then(a.samples.start.cmp(&b.samples.start))
        .then(a.samples.end.cmp(&b.samples.end))
        .then(a.reversed.cmp(&b.reversed))
}

fn lexical(a: &[f64], b: &[f64]) -> Ordering {
    let differ = a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
    differ.unwrap_or(a.len().cmp(&b.len()))
}

/// The trace to which an end of a gap belongs: the nearest.
fn trace_of_end(traces: &[&Trace], [x, y]: [f64; 2]) -> Option<usize> {
    let distance = |trace: &Trace| nearest(&trace.points, x, y).map_or(f64::INFINITY, |near| near.distance);
    let distances = traces.iter().map(|trace| distance(trace)).enumerate();
    distances.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(k, _)| k)
}

/// The end of one trace and the start of another that face each other along the contour, whichever is nearer.
fn facing(a: &Trace, b: &Trace) -> (Option<[f64; 2]>, Option<[f64; 2]>) {
    let place = |point: Option<&TracePoint>| point.map(|point| [point.x, point.y]);
    let ways = [(place(a.points.last()), place(b.points.first())), (place(b.points.last()), place(a.points.first()))];
    let far = |way: &(Option<[f64; 2]>, Option<[f64; 2]>)| match way {
        (Some(a), Some(b)) => (a[0] - b[0]).hypot(a[1] - b[1]),
        _ => f64::INFINITY,
    };
    let [one, other] = ways;
    if far(&one) <= far(&other) { one } else { other }
}
