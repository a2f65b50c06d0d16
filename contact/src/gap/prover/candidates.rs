//! Lines that may separate an interval of the rod from a run, as its closest points suggest them.

use super::{LARGEST_TURN, Search};
use crate::gap::interval::Knot;
use crate::gap::separator::Line;
use crate::scene::world::RunFoot;
use rod_contours::{Bend, Bounds, Run};
use rod_core::RodModel;

/// Distance (L) from a vertex below which the direction to it has lost half of its digits.
const AT_VERTEX: f64 = 1e-6;

impl<M: RodModel> Search<'_, M> {
    /// Hands out lines that keep the run behind them, as its closest point `foot` to an end of the interval suggests them,
    /// until one is taken.
    pub(super) fn candidates(
        &self,
        run: &Run,
        RunFoot { foot, stretch, end, joint }: &RunFoot,
        Knot { at, .. }: &Knot,
        length: f64,
        mut take: impl FnMut(Line) -> bool,
    ) {
        let line = |at: (f64, f64), normal: (f64, f64), outward: bool| Line { at, normal, outward };
        let ends = run.ends;
        let outward = run.bend == Bend::Outward;
        if outward && end.is_none() {
            if foot.gap >= -self.depth {
                let away = (at.x - foot.x).hypot(at.y - foot.y);
                let normal = if *joint && away < AT_VERTEX { foot.normal() } else { foot.uphill(at.x, at.y) };
                if take(line((foot.x, foot.y), normal, true)) {
                    return;
                }
                // at a vertex both its edges hold the run
                let edges = joint.then(|| self.world.joint_normals(*stretch));
                if edges.into_iter().flatten().any(|normal| take(line((foot.x, foot.y), normal, true))) {
                    return;
                }
            } else if let [Some(from), Some(to)] = &ends
                && from.into[0] * to.into[0] + from.into[1] * to.into[1] < -1.0 + f64::EPSILON
                && take(line((foot.x, foot.y), (-from.normal[0], -from.normal[1]), false))
            {
                return;
            }
        }
        // the chord, with the run on the side it bends to
        if let [Some(from), Some(to)] = &ends
            && run.bend != Bend::Mixed
        {
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            let chord = dx.hypot(dy);
            let side = if outward { -1.0 } else { 1.0 };
            if chord > 0.0 && take(line((from.x, from.y), (side * dy / chord, -side * dx / chord), !outward)) {
                return;
            }
        }
        for number in 0..2 {
            let Some(corner) = ends[number] else { continue };
            let (dx, dy) = (at.x - corner.x, at.y - corner.y);
            let away = dx.hypot(dy);
            if *end != Some(number) && away > 2.0 * length {
                continue;
            }
            let turn = if run.bend == Bend::Mixed { self.turn() } else { 0.0 };
            if turn > LARGEST_TURN {
                continue;
            }
            let holds = |(ux, uy): (f64, f64)| {
                let along = ux * corner.into[0] + uy * corner.into[1];
                // the chord bounds the run's directions on the other side
                let chord = ends[1 - number].map(|other| (other.x - corner.x, other.y - corner.y));
                let chord = chord.or(run.far[1 - number].map(|[x, y]| (x, y)));
                along <= f64::EPSILON - turn
                    && (turn > 0.0 || chord.is_some_and(|(x, y)| ux * x + uy * y <= f64::EPSILON))
            };
            let normal = (corner.normal[0], corner.normal[1]);
            if outward && take(line((corner.x, corner.y), normal, true)) {
                return;
            }
            let aim = if away > AT_VERTEX { (dx / away, dy / away) } else { normal };
            let (tangent, across) = ((at.cos, at.sin), (-at.sin, at.cos));
            let minus = |(x, y): (f64, f64)| (-x, -y);
            for normal in [aim, across, minus(across), tangent, minus(tangent)] {
                if holds(normal) && take(line((corner.x, corner.y), normal, false)) {
                    return;
                }
            }
        }
    }

    /// Largest angle between two tangents of the run, as its box and its curvature allow.
    fn turn(&self) -> f64 {
        let (least, largest) = self.world.run_curvature(self.run);
        let Bounds { min, max } = self.world.run_bounds(self.run);
        // an arc that turns by half a radian is longer than its chord by less than a tenth
        1.1 * (max[0] - min[0]).hypot(max[1] - min[1]) * largest.max(-least)
    }
}
