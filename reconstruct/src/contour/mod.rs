//! Contact points of a scan become stretches of a contour.

mod bins;
mod estimate;
mod gap;
mod leaps;
pub(crate) mod line;
mod measured;
mod point;
mod scatter;
mod smooth;
#[cfg(test)]
mod tests;

mod trace;

pub use estimate::{ContourEstimate, TraceRow};
pub use gap::{Gap, GapReason};
pub use measured::Measured;
pub use trace::{Trace, TraceCurve, TraceKind, TracePoint};

use bins::bins;
use leaps::leaps;
use line::Line;
use measured::Says;
use point::Point;
use smooth::smooth;
use std::ops::Range;

/// How the contact points of a scan are made into stretches of a contour.
///
/// Samples with one contact that follow each other make one [`Trace`], whether the contact is at the tip or tangential;
/// a [`Gap`] is where there are several contacts, none, or no answer, and where the contact leaps by far more than its
/// noise and its motion beside. Where it stands still, at a vertex or in a notch, the trace goes on. Points of samples
/// with several contacts become traces of their own, flagged by their kind. Nothing is interpolated across a gap.
///
/// The noise of a single point is averaged out along the trace: consecutive samples are averaged into bins, far enough
/// apart to be in order, and the bins are fitted together with the tangent angles, which give the shape more exactly
/// than the positions do. The stated standard deviation holds for noise as the covariances of the points tell, or as
/// their scatter shows where that is more. It includes correlation between samples, and how far off their mean may be
/// because a point does not depend linearly on what was measured; an error common to all of a trace it does not.
///
/// ```
/// use nalgebra::Matrix2;
/// use rod_reconstruct::{Assembly, GapReason, Label, Measured, Touch, TraceKind};
/// // Along a parabola from the right, with two samples of several contacts and their first contact on the way.
/// let touch = |k: i32| {
///     let x = 1e-3 * f64::from(10 - k);
///     let (y, alpha) = (50.0 * x * x, (100.0 * x).atan());
///     Touch { s: 0.08, x, y, alpha, force: 0.1, covariance: Matrix2::zeros() }
/// };
/// let touches: Vec<Touch> = (0..20).map(touch).collect();
/// let label = |k: usize| if k == 12 || k == 13 { Label::BB } else { Label::B };
/// let samples = touches.chunks(1).enumerate().map(|(k, one)| Measured::new(label(k), one));
///
/// let contour = Assembly::default().assemble(samples);
/// let single: Vec<_> = contour.of_kind(TraceKind::Single).collect();
/// assert_eq!((single.len(), contour.of_kind(TraceKind::First).count()), (2, 1));
/// assert!(single[0].reversed && (single[0].points[0].x + 1e-3).abs() < 1e-9);
/// assert_eq!((contour.gaps.len(), &contour.gaps[0].reason), (1, &GapReason::Several));
/// assert_eq!(contour.gaps[0].from, single[0].left());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assembly {
    /// Points are left out of a trace that depart from the polygon of the others by no more than this, m, or by half
    /// their standard deviation where that is more.
    pub tolerance: f64,
    /// So many consecutive samples without an answer, between samples with one contact each, do not end a trace.
    pub bridge: usize,
    /// Whether the tangent angles are those of the contour. They are not where several contacts were taken for one.
    pub tangents: bool,
}

impl Default for Assembly {
    /// A tolerance of 1 um, and 50 samples: 0.1 mm of a scan with 500 samples a second at 1 mm/s.
    fn default() -> Self {
        Self { tolerance: 1e-6, bridge: 50, tangents: true }
    }
}

impl Assembly {
    /// For points found as if every sample had one contact: their tangents are not used where they would have to fit
    /// the way of the points. Such contours of several scans are compared to find where the object is concave
    /// ([`Comparison`](crate::Comparison)). Leave out samples whose force is less than some 40 times its noise: there
    /// a point's error is not zero in the mean, and scans seem to disagree.
    pub fn naive() -> Self {
        Self { tangents: false, ..Self::default() }
    }

    /// The stretches and gaps of a scan, its samples in order.
    ///
    /// Samples whose contact point is not finite count as samples without an answer. The work is about linear in the
    /// number of samples.
    pub fn assemble<'a>(&self, samples: impl IntoIterator<Item = Measured<'a>>) -> ContourEstimate {
        let mut runs = Runs::default();
        for (sample, measured) in samples.into_iter().enumerate() {
            runs.add(sample, measured.says(sample), self.bridge);
        }
        runs.end_gap();
        let mut contour = ContourEstimate::default();
        let mut gaps = runs.gaps;
        for run in runs.single {
            for leap in self.add(TraceKind::Single, run, &mut contour.traces) {
                gaps.push((leap..leap, GapReason::Leap));
            }
        }
        gaps.sort_by_key(|(samples, _)| samples.start);
        contour.gaps = between(gaps, &contour.traces);
        for (kind, runs) in [(TraceKind::First, runs.first), (TraceKind::Second, runs.second)] {
            for run in runs {
                self.add(kind, run, &mut contour.traces);
            }
        }
        contour
    }

    /// Adds the traces of a run, and returns the samples at which it leaps.
    fn add(&self, kind: TraceKind, mut run: Vec<Point>, traces: &mut Vec<Trace>) -> Vec<usize> {
        scatter::complete(&mut run);
        let leaps = leaps(&run);
        let mut from = 0;
        for &to in leaps.iter().chain([&run.len()]) {
            let bins = bins(&run[from..to]);
            let estimates = smooth(&bins, self.tangents);
            let parts = Line::new(&bins, &estimates, self.tangents).parts(self.tolerance);
            traces.extend(parts.into_iter().map(|(samples, reversed, points)| Trace {
                kind,
                samples,
                reversed,
                points,
            }));
            from = to;
        }
        leaps.into_iter().map(|leap| run[leap].sample).collect()
    }
}

/// Gaps with their ends.
fn between(gaps: Vec<(Range<usize>, GapReason)>, single: &[Trace]) -> Vec<Gap> {
    let gap = |(samples, reason): (Range<usize>, GapReason)| {
        let before = single.partition_point(|trace| trace.samples.start < samples.start);
        let from = before.checked_sub(1).and_then(|k| single[k].left());
        let to = single[before..].iter().find(|trace| trace.samples.start >= samples.end).and_then(Trace::entered);
        Gap { samples, from, to, reason }
    };
    gaps.into_iter().map(gap).collect()
}

/// The samples of a scan, taken apart into consecutive ones of a kind.
#[derive(Default)]
struct Runs {
    single: Vec<Vec<Point>>,
    first: Vec<Vec<Point>>,
    second: Vec<Vec<Point>>,
    gaps: Vec<(Range<usize>, GapReason)>,
    open: Option<(Range<usize>, GapReason)>,
}

impl Runs {
    fn add(&mut self, sample: usize, says: Says, bridge: usize) {
        match says {
            Says::Single(point) => {
                let short = |(gap, reason): &(Range<usize>, GapReason)| {
                    matches!(reason, GapReason::NoAnswer(_)) && gap.len() <= bridge
                };
                // Only between samples of single contact: what comes before the gap must be the run's last sample.
                let from = self.open.as_ref().filter(|open| short(open)).map_or(sample, |(gap, _)| gap.start);
                match self.single.last_mut() {
                    Some(run) if run.last().is_some_and(|last| last.sample + 1 == from) => {
                        run.push(point);
                        self.open = None;
                    }
                    _ => self.single.push(vec![point]),
                }
                self.end_gap();
            }
            Says::Several(first, second) => {
                append(&mut self.first, first);
                append(&mut self.second, second);
                self.miss(sample, GapReason::Several);
            }
            Says::Free => self.miss(sample, GapReason::Free),
            Says::Nothing(reason) => self.miss(sample, GapReason::NoAnswer(reason)),
        }
    }

    /// Goes on with the gap of this kind, or begins it.
    fn miss(&mut self, sample: usize, reason: GapReason) {
        match &mut self.open {
            Some((gap, open)) if std::mem::discriminant(open) == std::mem::discriminant(&reason) => {
                gap.end = sample + 1
            }
            _ => {
                self.end_gap();
                self.open = Some((sample..sample + 1, reason));
            }
        }
    }

    fn end_gap(&mut self) {
        self.gaps.extend(self.open.take());
    }
}

/// Goes on with the last run, or begins one.
fn append(runs: &mut Vec<Vec<Point>>, point: Option<Point>) {
    let Some(point) = point else { return };
    match runs.last_mut() {
        Some(run) if run.last().is_some_and(|last| last.sample + 1 == point.sample) => run.push(point),
        _ => runs.push(vec![point]),
    }
}
