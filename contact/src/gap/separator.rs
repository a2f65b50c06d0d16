//! Straight lines that keep a run of a contour on one side.

use super::interval::Interval;
use crate::gap::shape::Node;
use rod_contours::Run;
use smallvec::SmallVec;

/// Largest number of separating lines kept of one run. More are tried in vain for intervals that none of them clears; fewer
/// must be found again.
const KEPT: usize = 12;

/// A line with the run on or behind it. It belongs to the contour alone: found once, it holds in every later state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// A point of the line.
    pub at: (f64, f64),
    /// The unit normal away from the run.
    pub normal: (f64, f64),
    /// Whether the normal is the contour's outward one, so that what is in front of the line is on the outer side of the
    /// run. In front of another line it may be behind the contour.
    pub outward: bool,
}

impl Line {
    fn height(&self, Node { at, .. }: &Node) -> f64 {
        (at.x - self.at.0) * self.normal.0 + (at.y - self.at.1) * self.normal.1
    }

    /// How many of the intervals between `nodes` are farther than `least` in front of the line, from the first one on, and
    /// the least height over them. Hands out those that are not farther than `near`. `interval` gives one of them.
    fn clears(
        &self,
        nodes: &[Node],
        interval: impl Fn(usize) -> Interval,
        (least, near): (f64, f64),
        mut touch: impl FnMut(usize, &Self),
    ) -> (usize, f64) {
        let [first, rest @ ..] = nodes else { return (0, f64::INFINITY) };
        let (mut before, mut bulge, mut lowest) = (self.height(first), first.bulge, f64::INFINITY);
        for (count, node) in rest.iter().enumerate() {
            let after = self.height(node);
            let mut bound = before.min(after) - bulge;
            if bound <= near {
                // where the ends alone do not settle it the slopes may
                if before.min(after) > least {
                    bound = self.bound(&interval(count));
                }
                if bound <= least {
                    return (count, lowest);
                }
                if bound <= near {
                    touch(count, self);
                }
            }
            lowest = lowest.min(bound);
            (before, bulge) = (after, node.bulge);
        }
        (rest.len(), lowest)
    }

    /// Lower bound of the distance from the run over an interval; below zero it says nothing.
    pub fn bound(&self, interval: &Interval) -> f64 {
        interval.least_height(self.at, self.normal)
    }
}

/// What is known of one run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    /// The run, once it has been near.
    pub run: Option<Run>,
    lines: SmallVec<[Line; 4]>,
    /// The one that was of use last: neighbouring intervals mostly share it.
    last: usize,
}

impl Lines {
    pub fn keep(&mut self, line: Line) {
        if self.lines.len() < KEPT {
            self.last = self.lines.len();
            self.lines.push(line);
        } else {
            self.last = (self.last + 1) % KEPT;
            self.lines[self.last] = line;
        }
    }

    /// How many intervals between `nodes` one of the `tangents`, or else of the lines, clears by more than the first of `limits`, from
    /// the first one on, and the bound. Hands out those that are not farther from it than the second one.
    pub fn clear<'a>(
        &mut self,
        nodes: &[Node],
        interval: impl Fn(usize) -> Interval,
        limits: (f64, f64),
        mut tangents: impl Iterator<Item = &'a Line>,
        mut touch: impl FnMut(usize, &Line),
    ) -> Option<(usize, f64)> {
        let mut clears = |line: &Line| {
            let (count, bound) = line.clears(nodes, &interval, limits, &mut touch);
            (count > 0).then_some((count, bound))
        };
        tangents.find_map(&mut clears).or_else(|| self.try_each(clears))
    }

    /// The bound of the first line that clears an interval.
    pub fn clear_interval(&mut self, interval: &Interval, least: f64) -> Option<(f64, Line)> {
        self.try_each(|line| {
            let bound = line.bound(interval);
            (bound > least).then_some((bound, *line))
        })
    }

    /// The first line that `clears` something.
    pub fn find(&mut self, mut clears: impl FnMut(&Line) -> bool) -> Option<Line> {
        self.try_each(|line| clears(line).then_some(*line))
    }

    fn try_each<T>(&mut self, mut try_one: impl FnMut(&Line) -> Option<T>) -> Option<T> {
        let (count, first) = (self.lines.len(), self.last);
        (0..count).map(|k| (first + k) % count).find_map(|k| {
            let found = try_one(&self.lines[k])?;
            self.last = k;
            Some(found)
        })
    }
}
