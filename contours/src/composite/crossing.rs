//! Search for the place where a contour enters the solid of the next one.

use crate::point::cross;
use crate::{Contour, Frame, Range};

/// Cells in which the search begins.
const CELLS: usize = 256;

/// Halvings of a cell in search of a pair of crossings within it.
const HALVINGS: u32 = 4;

/// Margin on the length of a cell, which is estimated from three speeds.
const LENGTH_MARGIN: f64 = 1.5;

/// Steps of the refinement: bisection to within Newton's reach, Newton to rounding, which takes 2 to 5.
const BISECTIONS: usize = 60;
const NEWTON_STEPS: usize = 16;

/// Largest gap left at a crossing, relative to its coordinates; the sign also changes beyond the end of a contour, at its
/// tangent's continuation, and that is no crossing.
const ON_BOTH: f64 = 1e-9;

/// A crossing: parameters of the first contour and of the one whose solid it enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub leaves: f64,
    pub enters: f64,
}

/// The first point after `start` where `shape`, walked along its range, enters the solid of `next`; without one, the last
/// such point before `start`.
///
/// The gap to `next` changes no faster than the point moves, so a cell whose gaps at both ends add up to more than its
/// length holds no crossing; the other cells are halved, 4 times at most. Two crossings closer than 1/16 of a cell
/// (of 256, see `Range::at`) can be missed, as can any that are more than 1e4 along an infinite range.
pub(crate) fn entry(shape: &dyn Contour, next: &dyn Contour, start: f64) -> Option<Crossing> {
    let range = shape.range();
    let walk = Walk { shape, next };
    let mut before = None;
    let mut left = walk.stop(range.at(0.0));
    for cell in 1..=CELLS {
        let right = walk.stop(range.at(cell as f64 / CELLS as f64));
        let mut found = |crossing: Crossing| {
            if crossing.leaves > start {
                return true;
            }
            before = Some(crossing);
            false
        };
        if let Some(crossing) = walk.entry(left, right, HALVINGS, &mut found) {
            return Some(crossing);
        }
        left = right;
    }
    before
}

/// A place on the first contour.
#[derive(Clone, Copy)]
struct Stop {
    t: f64,
    speed: f64,
    gap: f64,
}

struct Walk<'a> {
    shape: &'a dyn Contour,
    next: &'a dyn Contour,
}

impl Walk<'_> {
    fn stop(&self, t: f64) -> Stop {
        let frame = self.shape.frame(t);
        Stop { t, speed: frame.speed, gap: self.next.gap(frame.x, frame.y) }
    }

    /// The first crossing between two stops that `wanted` accepts.
    fn entry(
        &self,
        left: Stop,
        right: Stop,
        halvings: u32,
        wanted: &mut impl FnMut(Crossing) -> bool,
    ) -> Option<Crossing> {
        let enters = left.gap > 0.0 && right.gap <= 0.0;
        let middle = self.stop(0.5 * (left.t + right.t));
        let speed = left.speed.max(right.speed).max(middle.speed);
        let length = LENGTH_MARGIN * speed * (right.t - left.t);
        let same_side = (left.gap > 0.0) == (right.gap > 0.0);
        if same_side && left.gap.abs() + right.gap.abs() > length {
            return None;
        }
        if halvings == 0 {
            return if enters { self.refine(left, right).filter(|&found| wanted(found)) } else { None };
        }
        self.entry(left, middle, halvings - 1, wanted).or_else(|| self.entry(middle, right, halvings - 1, wanted))
    }

    /// The crossing between a stop outside and a stop inside; `None` if the sign changes without the gap vanishing.
    fn refine(&self, outside: Stop, inside: Stop) -> Option<Crossing> {
        let (mut low, mut high) = (outside, inside);
        for _ in 0..BISECTIONS {
            let middle = self.stop(0.5 * (low.t + high.t));
            if middle.t <= low.t || middle.t >= high.t {
                break;
            }
            if middle.gap > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let frame = self.shape.frame(high.t);
        let scale = frame.x.abs().max(frame.y.abs()).max(high.t.abs());
        if low.gap.abs().max(high.gap.abs()) > ON_BOTH * scale {
            return None;
        }
        let places = [high.t, self.next.closest(frame.x, frame.y).t];
        let frames = |[leaves, enters]: [f64; 2]| [self.shape.frame(leaves), self.next.frame(enters)];
        let (_, [leaves, enters]) = newton_crossing(places, [self.shape.range(), self.next.range()], frames);
        Some(Crossing { leaves, enters })
    }
}

/// Newton's iteration on `r1(places[0]) = r2(places[1])`, as long as it brings the two points together: how far apart
/// they are then, and the places.
pub(crate) fn newton_crossing(
    places: [f64; 2],
    ranges: [Range; 2],
    frames: impl Fn([f64; 2]) -> [Frame; 2],
) -> (f64, [f64; 2]) {
    let mut best = (f64::INFINITY, places);
    let mut trial = places;
    for _ in 0..NEWTON_STEPS {
        let [one, two] = frames(trial);
        let distance = one.distance(two.x, two.y);
        if distance < best.0 {
            best = (distance, trial);
        } else {
            break;
        }
        let apart = [two.x - one.x, two.y - one.y];
        let [along_one, along_two] = [one, two].map(|frame| frame.alpha.sin_cos()).map(|(sin, cos)| [cos, sin]);
        let sine = cross(along_one, along_two);
        trial = [
            ranges[0].clamp(trial[0] + cross(apart, along_two) / (sine * one.speed)),
            ranges[1].clamp(trial[1] + cross(apart, along_one) / (sine * two.speed)),
        ];
    }
    best
}
