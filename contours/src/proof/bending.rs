//! Where a curve with limits of its curvature bends one way only.

use std::f64::consts::PI;

use super::limits::LimitsOf;
use crate::nearest::cuts::{at_equal_turns, last_where};
use crate::{Frame, Range};

/// Angle (rad) that a part of undecided sense may turn and still count as straight: rounding. A curve leaves its tangent by
/// less than this times its length.
const STRAIGHT: f64 = 1e-12;

/// Largest number of parts. Limits that do not tighten on smaller parts end the search here.
const MOST: usize = 10_000;

/// Times a range is halved.
const HALVINGS: u32 = 40;

/// A part and the way it bends: 1 to the left, -1 to the right, 0 neither or undecided.
struct Bend {
    range: Range,
    sense: f64,
}

/// The largest parts of the range, in order, for which the limits determine the sense of bending; `None` if there are too many.
fn bends(limits: &LimitsOf, range: Range) -> Option<Vec<Bend>> {
    let mut found = Vec::new();
    let mut open = vec![(range, HALVINGS)];
    let mut looked = 0;
    while let Some((part, halvings)) = open.pop() {
        looked += 1;
        if looked > MOST {
            return None;
        }
        let limit = limits(part);
        let (least, largest) = limit.curvature;
        let turn = least.abs().max(largest.abs()) * limit.speed * part.length();
        let sense = match (least >= 0.0, largest <= 0.0) {
            (true, false) => 1.0,
            (false, true) => -1.0,
            _ if turn <= STRAIGHT => 0.0,
            (true, true) => 0.0,
            (false, false) if halvings > 0 => {
                let middle = part.at(0.5);
                open.push((Range { from: middle, ..part }, halvings - 1));
                open.push((Range { to: middle, ..part }, halvings - 1));
                continue;
            }
            (false, false) => return None,
        };
        found.push(Bend { range: part, sense });
    }
    Some(found)
}

/// The inflections, and between them cuts at equal angles; `None` if the limits do not determine the inflections.
pub(crate) fn cuts(frame: impl Fn(f64) -> Frame, limits: &LimitsOf, range: Range) -> Option<Vec<f64>> {
    let bends = bends(limits, range)?;
    let mut inflections = Vec::new();
    let mut last: Option<&Bend> = None;
    for bend in bends.iter().filter(|bend| bend.sense != 0.0) {
        if let Some(before) = last
            && before.sense != bend.sense
        {
            // The undecided part between the two is short.
            let same = |t: f64| frame(t).turning * before.sense > 0.0;
            inflections.push(last_where(before.range.to, bend.range.from, same));
        }
        last = Some(bend);
    }
    Some(at_equal_turns(frame, range, &inflections))
}

/// Whether the part bends one way and turns by at most a half turn: then it lies on one side of each of its tangents.
pub(crate) fn is_convex(frame: impl Fn(f64) -> Frame, limits: &LimitsOf, range: Range) -> bool {
    if (frame(range.to).alpha - frame(range.from).alpha).abs() > PI {
        return false;
    }
    bends(limits, range)
        .is_some_and(|bends| [1.0, -1.0].iter().any(|&sense| bends.iter().all(|bend| bend.sense != sense)))
}
