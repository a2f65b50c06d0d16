//! The assembly of a contour.

use super::bins::bins;
use super::estimate::{ContourEstimate, Gap, GapReason};
use super::leaps::leaps;
use super::line::BinLine;
use super::measured::{ContactPoint, Measured, SamplePoints};
use super::scatter;
use super::smooth::smooth;
use super::trace::{Trace, TraceKind};
use std::ops::Range;

/// Runs of consecutive points of a kind, and the gaps between them.
#[derive(Default)]
pub(super) struct Runs {
    pub single: Vec<Vec<ContactPoint>>,
    pub first: Vec<Vec<ContactPoint>>,
    pub second: Vec<Vec<ContactPoint>>,
    pub gaps: Vec<(Range<usize>, GapReason)>,
    open: Option<(Range<usize>, GapReason)>,
}

impl Runs {
    /// Adds the points of a sample; `bridge` is that of the assembly.
    pub fn add(&mut self, sample: usize, points: SamplePoints, bridge: usize) {
        match points {
            SamplePoints::Single(point) => {
                let short = |(gap, reason): &(Range<usize>, GapReason)| {
                    matches!(reason, GapReason::NoAnswer(_)) && gap.len() <= bridge
                };
                // only between samples of single contact: the sample before the gap must be the last one of the run
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
            SamplePoints::Several(first, second) => {
                append(&mut self.first, first);
                append(&mut self.second, second);
                self.miss(sample, GapReason::Several);
            }
            SamplePoints::Free => self.miss(sample, GapReason::Free),
            SamplePoints::Nothing(reason) => self.miss(sample, GapReason::NoAnswer(reason)),
        }
    }

    /// Continues the gap of this kind, or begins one.
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

    /// Ends the gap that is open, if one is.
    pub fn end_gap(&mut self) {
        self.gaps.extend(self.open.take());
    }
}

/// Continues the last run, or begins one.
fn append(runs: &mut Vec<Vec<ContactPoint>>, point: Option<ContactPoint>) {
    let Some(point) = point else { return };
    match runs.last_mut() {
        Some(run) if run.last().is_some_and(|last| last.sample + 1 == point.sample) => run.push(point),
        _ => runs.push(vec![point]),
    }
}

/// How the contact points of a scan are assembled into stretches of a contour.
///
/// Consecutive samples with one contact make one [`Trace`], whether the contact is at the tip or tangential. A [`Gap`] is where there
/// are several contacts, none, or no answer, and where the contact leaps by far more than its noise and its motion nearby.
/// Where the contact stands still, at a vertex or in a notch, the trace goes on. Points of samples with several contacts become
/// traces of their own kinds. Nothing is interpolated across a gap.
///
/// Along a trace the noise is averaged out: consecutive samples are averaged into bins that are far enough apart to be in order. The
/// bins are fitted together with the tangent angles, which determine the shape more exactly than the positions do. The standard
/// deviation of the result uses the covariances of the points, or their scatter where that is larger. It includes the
/// correlation between samples, and the bias of a mean of points that are not linear in the reactions. It does not include an
/// error common to a whole trace.
///
/// ```
/// use nalgebra::Matrix2;
/// use rod_reconstruct::{Assembly, GapReason, Label, Measured, Touch, TraceKind};
/// // Along a parabola from the right, with two samples of several contacts and their first contact on the way.
/// let touch = |k: i32| {
///     let x = 1e-3 * f64::from(10 - k);
///     let (y, alpha) = (50.0 * x * x, (100.0 * x).atan());
///     Touch { s: 0.08, x, y, alpha, force: 0.1, covariance: Matrix2::zeros(), systematic: Matrix2::zeros() }
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
    /// Largest departure, m, of a point from the polygon of the others at which it is left out; half its standard deviation where
    /// that is larger.
    pub tolerance: f64,
    /// Most consecutive samples without an answer, between samples with one contact each, that do not end a trace.
    pub bridge: usize,
    /// Whether the tangent angles are those of the contour. They are not where several contacts are taken for one.
    pub tangents: bool,
}

impl Default for Assembly {
    /// A tolerance of 1 um, and 50 samples: 0.1 mm of a scan with 500 samples a second at 1 mm/s.
    fn default() -> Self {
        Self { tolerance: 1e-6, bridge: 50, tangents: true }
    }
}

impl Assembly {
    /// For points computed as if every sample had one contact: their tangents are not used. Such contours of several scans are compared
    /// to find concave parts of an object ([`Comparison`](crate::Comparison)). Leave out samples whose force is less than about
    /// 40 times its noise: their points are biased, and scans seem to disagree.
    pub fn naive() -> Self {
        Self { tangents: false, ..Self::default() }
    }

    /// The stretches and gaps of a scan from its samples in order.
    ///
    /// Samples whose contact point is not finite count as samples without an answer. The time is about linear in the number of
    /// samples.
    pub fn assemble<'a>(&self, samples: impl IntoIterator<Item = Measured<'a>>) -> ContourEstimate {
        let mut runs = Runs::default();
        for (sample, measured) in samples.into_iter().enumerate() {
            runs.add(sample, measured.contour_points(sample), self.bridge);
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
    fn add(&self, kind: TraceKind, mut run: Vec<ContactPoint>, traces: &mut Vec<Trace>) -> Vec<usize> {
        scatter::complete(&mut run);
        let leaps = leaps(&run);
        let mut from = 0;
        for &to in leaps.iter().chain([&run.len()]) {
            let bins = bins(&run[from..to]);
            let estimates = smooth(&bins, self.tangents);
            let parts = BinLine::new(&bins, &estimates, self.tangents).parts(self.tolerance);
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
