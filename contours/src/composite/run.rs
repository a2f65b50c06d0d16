//! Runs: neighbouring arcs of a contour that bend one way, so that one straight line can separate a rod from all of them.

use std::f64::consts::PI;

use super::piece::Piece;
use crate::point::wrap_angle;
use crate::{Bounds, Contour, Frame, Range, Vector};

/// A kink between two pieces that bends the wrong way by no more than this is rounding, rad. It moves a line that should
/// support the run by this angle times the run's length.
const STRAIGHT: f64 = 1e-13;

/// A parameter at which the tangent angle equals that at infinity. Its square is still finite.
const AT_INFINITY: f64 = 1e150;

/// How the arcs of a [`Run`] bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// Towards the solid, or not at all: together they lie behind each of their tangents.
    Outward,
    /// Away from the solid: a single arc, which lies in front of each of its tangents.
    Inward,
    /// Unknown, or both ways: a single arc.
    Mixed,
}

/// An end of a [`Run`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    /// Position, a length.
    pub x: f64,
    /// Position, a length.
    pub y: f64,
    /// Direction along the contour into the run.
    pub into: Vector,
    /// Outward normal of the contour.
    pub normal: Vector,
}

/// Neighbouring arcs of a contour that bend one way.
///
/// Arcs that bend outwards form one run over smooth joints and convex corners as long as they turn by no more than half a
/// turn together, or where they are all of a closed contour. Then the run lies behind each of its tangents, and so does
/// the region between it and the chord between its ends (its convex hull).
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// How it bends.
    pub bend: Bend,
    /// Whether bend and closest points are proven, not sampled.
    pub proven: bool,
    /// Whether it is a whole closed contour.
    pub closed: bool,
    /// The ends, in the contour's order; none at infinity, and none of a closed run.
    pub ends: [Option<RunEnd>; 2],
    /// The direction in which the run goes to infinity, where it does.
    pub far: [Option<Vector>; 2],
    /// A box that contains it.
    pub bounds: Bounds,
}

/// A run as it is kept: there may be 1e5 of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StoredRun {
    /// Numbers of the first cell and of the one behind the last.
    pub cells: [u32; 2],
    pub bend: Bend,
    pub proven: bool,
    pub closed: bool,
}

/// One arc of a piece, as the runs are made from.
pub(crate) struct Arc<'a> {
    pub piece: &'a Piece,
    pub range: Range,
    /// Turn of the joint after it, where it is the last of its piece; 0 where the contour goes on smoothly.
    pub joint: f64,
}

/// The runs of a contour, in its order. `turns` is 0 for an open contour.
pub(crate) fn group_into_runs<'a>(arcs: impl Iterator<Item = Arc<'a>>, turns: i32) -> Vec<StoredRun> {
    let mut runs: Vec<StoredRun> = Vec::new();
    let mut ends_at_infinity = false;
    // turn of the last run, and of the joint after it
    let (mut turned, mut joint, mut whole) = (0.0, 0.0, 0.0);
    let mut before: Option<Frame> = None;
    for (number, arc) in (0_u32..).zip(arcs) {
        let Arc { piece, range, joint: after } = arc;
        let (bend, proven) = bend(piece, range);
        let frames = [range.from, range.to].map(|t| t.is_finite().then(|| piece.own_frame(t)));
        let turn = if let [Some(from), Some(to)] = frames { to.alpha - from.alpha } else { PI };
        // where no joint stands, the frames still tell of a kink too small for one
        let kink = match (before, frames[0]) {
            (Some(was), Some(is)) if joint == 0.0 => wrap_angle(is.alpha - was.alpha),
            _ => joint,
        };
        let goes_on = runs.last().is_some_and(|run| run.bend == Bend::Outward) && !ends_at_infinity;
        let fits = goes_on && bend == Bend::Outward && kink >= -STRAIGHT && turned + kink + turn <= PI;
        match runs.last_mut().filter(|_| fits) {
            Some(run) => {
                run.cells[1] = number + 1;
                run.proven &= proven;
                turned += kink + turn;
            }
            None => {
                runs.push(StoredRun { cells: [number, number + 1], bend, proven, closed: false });
                turned = turn;
            }
        }
        whole += if number > 0 { kink.min(0.0) } else { 0.0 };
        (joint, before, ends_at_infinity) = (after, frames[1], frames[1].is_none());
    }
    // the seam of a closed contour has a joint as well
    whole += joint.min(0.0);
    if turns == 1 && whole >= -STRAIGHT && runs.iter().all(|run| run.bend == Bend::Outward) {
        let cells = [0, runs.last().map_or(0, |run| run.cells[1])];
        let proven = runs.iter().all(|run| run.proven);
        return vec![StoredRun { cells, bend: Bend::Outward, proven, closed: true }];
    }
    runs
}

/// How a part of a piece bends, and whether that is proven: one that lies on one side of its tangents shows it anywhere.
fn bend(piece: &Piece, range: Range) -> (Bend, bool) {
    let proven = piece.shape.is_convex(range) && piece.shape.closest_is_exact();
    let part = range.window(1.0);
    let (mut outward, mut inward) = (false, false);
    for share in [0.5, 0.25, 0.75, 0.01, 0.99] {
        let Frame { turning, .. } = piece.shape.frame(part.from + share * (part.to - part.from));
        outward |= turning > 0.0;
        inward |= turning < 0.0;
        if proven && (outward || inward) {
            break;
        }
    }
    match (outward, inward) {
        (true, true) => (Bend::Mixed, false),
        (false, true) => (Bend::Inward, proven),
        _ => (Bend::Outward, proven),
    }
}

impl Run {
    /// A stored run, from the pieces and parts of the first and the last of its arcs and a box around all of them.
    pub(crate) fn new(stored: &StoredRun, [first, last]: [(&Piece, Range); 2], bounds: Bounds) -> Self {
        let StoredRun { bend, proven, closed, .. } = *stored;
        let at = [(first.0, first.1.from, 1.0), (last.0, last.1.to, -1.0)];
        let open = |value: Option<_>| value.filter(|_| !closed);
        let ends = at.map(|(piece, t, sign)| open(t.is_finite().then(|| end(&piece.own_frame(t), sign))));
        let far = at.map(|(piece, t, sign)| far(piece, t, -sign).filter(|_| !closed));
        Self { bend, proven, closed, ends, far, bounds }
    }
}

/// The direction in which a piece goes to infinity at an end of its range: what bends one way has one.
fn far(piece: &Piece, t: f64, sign: f64) -> Option<Vector> {
    let alpha = t.is_infinite().then(|| piece.own_frame(t.signum() * AT_INFINITY).alpha)?;
    let (sin, cos) = alpha.sin_cos();
    alpha.is_finite().then_some([sign * cos, sign * sin])
}

fn end(frame: &Frame, sign: f64) -> RunEnd {
    let (sin, cos) = frame.alpha.sin_cos();
    RunEnd { x: frame.x, y: frame.y, into: [sign * cos, sign * sin], normal: [sin, -cos] }
}
