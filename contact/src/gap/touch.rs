//! Where a rod that goes through a contour has met it first: the point of the contour that reaches farthest across the rod.

use super::interval::Knot;
use super::{Crossing, GAP_TOLERANCE};
use crate::gap::shape::Shape;
use crate::scene::rod;
use crate::scene::world::{Foot, RunFoot, World};
use rod_contours::Bend;
use rod_core::{Cut, RodModel};
use std::f64::consts::PI;

/// Tolerance (L) of the deepest point of the rod, from which Newton's method starts.
const NEAR_ENOUGH: f64 = 1e-9;
/// Limit of doublings and halvings of the way along the rod.
const MOST_LOOKS: usize = 60;
/// Angle (rad) between rod and contour below which they count as parallel.
const PARALLEL: f64 = 1e-6;
/// Curvature (1 / L) of a straight rod by rounding.
const STRAIGHT: f64 = 1e-9;
/// Sine of the angle between a straight rod and an edge below which the rod lies on the edge.
const FLUSH: f64 = 1e-12;
/// Limit of stretches in the search for the one that the rod is parallel to.
const MOST_STRETCHES: usize = 64;

/// A rod in some shape.
pub(super) struct Rod<'a, M> {
    pub model: &'a M,
    pub world: &'a World<'a>,
    pub shape: &'a Shape,
}

impl<M: RodModel> Rod<'_, M> {
    /// The rod and its slope angle, whole turns included, at an arc length.
    fn section(&self, s: f64) -> Cut {
        rod::along(self.model, &self.shape.segments, s)
    }

    fn foot(&self, run: usize, s: f64) -> (Cut, RunFoot, f64) {
        let at = self.section(s);
        let foot = self.world.run_foot(run, at.x, at.y);
        let (sin, cos) = at.phi.sin_cos();
        let (nx, ny) = foot.foot.uphill(at.x, at.y);
        (at, foot, nx * cos + ny * sin)
    }

    /// Where the rod, inside the run at `knot`, has met it.
    pub fn touch(&self, run: usize, knot: &Knot) -> Crossing {
        let s = self.deepest(run, knot.s);
        let (at, RunFoot { foot, stretch, .. }, slope) = self.foot(run, s);
        let flat = self.beside_edge(stretch, &foot, s, &at);
        if flat.is_none() && s >= 1.0 && slope < 0.0 {
            return Crossing { stretch, s: 1.0, phi: at.phi, foot, tip: true };
        }
        let across = flat.or_else(|| self.farthest(run, stretch, &foot, s, &at));
        let Some((stretch, t)) = across else {
            return Crossing { stretch, s, phi: at.phi, foot, tip: false };
        };
        let support = self.world.support(stretch, t);
        let (s, at) = self.beside(s, (support.x, support.y));
        let (sin, cos) = support.alpha.sin_cos();
        let gap = ((at.x - support.x) * sin - (at.y - support.y) * cos).min(-GAP_TOLERANCE);
        let foot = Foot {
            t,
            gap: gap.max(foot.gap.min(-2.0 * GAP_TOLERANCE)),
            alpha: support.alpha,
            x: support.x,
            y: support.y,
            interior: true,
        };
        Crossing { stretch, s, phi: at.phi, foot, tip: false }
    }

    /// The corner next to the clamp at the end of a straight edge that a straight rod is parallel to: the rod comes to lie on
    /// the edge everywhere at once, and there it is held first.
    fn beside_edge(&self, stretch: usize, foot: &Foot, s: f64, at: &Cut) -> Option<(usize, f64)> {
        let world = self.world;
        let off = (at.phi - foot.alpha).sin();
        if world.is_corner(stretch) || world.support(stretch, foot.t).turning != 0.0 || off.abs() > FLUSH {
            return None;
        }
        if self.model.curvature_at(s, at.moment).abs() > STRAIGHT {
            return None;
        }
        let backwards = (at.phi - foot.alpha).cos() < 0.0;
        let corner = world.neighbour(stretch, backwards).filter(|next| world.is_corner(*next))?;
        Some((corner, world.border(corner, !backwards)))
    }

    /// The arc length near `s` at which the gap to the run is a minimum, or the end of the rod that it falls to.
    fn deepest(&self, run: usize, s: f64) -> f64 {
        let slope = |s: f64| self.foot(run, s).2;
        let first = slope(s);
        let way = if first < 0.0 { 1.0 } else { -1.0 };
        let (mut from, mut step) = (s, 1e-3);
        let mut to = s;
        for _ in 0..MOST_LOOKS {
            to = (from + way * step).clamp(0.0, 1.0);
            if slope(to) * way >= 0.0 {
                break;
            }
            if to == 0.0 || to == 1.0 {
                return to;
            }
            (from, step) = (to, 2.0 * step);
        }
        for _ in 0..MOST_LOOKS {
            if (to - from).abs() < NEAR_ENOUGH {
                break;
            }
            let middle = 0.5 * (from + to);
            if slope(middle) * way >= 0.0 {
                to = middle;
            } else {
                from = middle;
            }
        }
        // at the tip itself the gap may still fall by less than this
        if from > 1.0 - NEAR_ENOUGH { 1.0 } else { from }
    }

    /// The point of the run, next to `foot`, where the contour is parallel to the rod: the stretch and its
    /// parameter. None where the foot itself is, or where the run ends before.
    fn farthest(&self, run: usize, stretch: usize, foot: &Foot, s: f64, at: &Cut) -> Option<(usize, f64)> {
        let Cut { phi, moment, .. } = *at;
        let kappa = self.model.curvature_at(s, moment);
        let lean = phi - foot.alpha;
        let lean = lean - PI * (lean / PI).round();
        let world = self.world;
        // along a straight rod nothing of a straight edge but its ends is farther than the rest
        let straight = kappa.abs() < STRAIGHT && !world.is_corner(stretch);
        let straight = straight && world.support(stretch, foot.t).turning == 0.0;
        if lean.abs() < if straight { FLUSH } else { PARALLEL } {
            return None;
        }
        if world.run(run).bend != Bend::Outward {
            return self.corner_beside(stretch, foot, phi);
        }
        let upwards = lean > 0.0;
        let mut here = stretch;
        let mut rest = lean;
        let mut alpha = foot.alpha;
        for _ in 0..MOST_STRETCHES {
            let border = world.border(here, upwards);
            if !border.is_finite() {
                return None;
            }
            let end = world.support(here, border).alpha;
            let turn = end - alpha;
            if (rest - turn) * lean <= 0.0 {
                return Some((here, self.parallel(here, alpha + rest, border, foot.t, here == stretch, upwards)));
            }
            rest -= turn;
            here = world.neighbour(here, upwards).filter(|next| !world.is_notch(*next))?;
            alpha = world.support(here, world.border(here, !upwards)).alpha;
        }
        None
    }

    /// The corner at an end of a stretch that a rod of slope angle `phi` can lie on, the one next to `foot` of two.
    fn corner_beside(&self, stretch: usize, foot: &Foot, phi: f64) -> Option<(usize, f64)> {
        let world = self.world;
        let corners = [false, true].into_iter().filter_map(|after| {
            let corner = world.neighbour(stretch, after).filter(|next| world.is_corner(*next))?;
            let (from, to) = (world.border(corner, false), world.border(corner, true));
            let at = world.support(corner, from);
            let turned = (phi - at.alpha).rem_euclid(PI);
            let distance = (at.x - foot.x).hypot(at.y - foot.y);
            (turned <= to - from).then_some((distance, (corner, from + turned)))
        });
        corners.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
    }

    /// The parameter of a stretch where its tangent angle is `alpha`.
    fn parallel(&self, stretch: usize, alpha: f64, border: f64, t: f64, own: bool, upwards: bool) -> f64 {
        let mut from = if own { t } else { self.world.border(stretch, !upwards) };
        let mut to = border;
        let sign = if upwards { 1.0 } else { -1.0 };
        for _ in 0..MOST_LOOKS {
            let middle = 0.5 * (from + to);
            if (self.world.support(stretch, middle).alpha - alpha) * sign < 0.0 {
                from = middle;
            } else {
                to = middle;
            }
        }
        0.5 * (from + to)
    }

    /// The point of the rod, from `s` on, that is next to a point of the plane.
    fn beside(&self, mut s: f64, (x, y): (f64, f64)) -> (f64, Cut) {
        let mut at = self.section(s);
        for _ in 0..8 {
            let (sin, cos) = at.phi.sin_cos();
            let (dx, dy) = (at.x - x, at.y - y);
            let rate = (1.0 + self.model.curvature_at(s, at.moment) * (dy * cos - dx * sin)).max(0.1);
            s = (s - (dx * cos + dy * sin) / rate).clamp(0.0, 1.0);
            at = self.section(s);
        }
        (s, at)
    }
}
