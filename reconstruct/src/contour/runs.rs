//! The samples of a scan, taken apart into consecutive ones of a kind.

use super::gap::GapReason;
use super::measured::{ContactPoint, SamplePoints};
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
