//! The rod, as reactions and the forces on it bend it.

use nalgebra::Vector2;
use rod_core::{Elastica, Load, PhysicalRod, Pose, Reactions};

/// A rod whose support is at a pose, with these reactions, under forces (N) at arc lengths (m) in their order; none where it turns too fast.
pub(super) fn bent<R: PhysicalRod>(
    rod: &R,
    pose: Pose,
    reactions: &Reactions,
    forces: &[(f64, Vector2<f64>)],
) -> Option<Elastica<R::Model>> {
    let load = |(s, force): &(f64, Vector2<f64>)| Load { s: *s, force: force.norm(), alpha: alpha_of(*force) };
    let loads: Vec<Load> = forces.iter().map(load).collect();
    let base = rod.base(pose, reactions);
    Elastica::of_rod(rod.model().clone(), rod.units(), base, reactions.m0z, &loads).ok()
}

/// The force on a rod that its contacts have in all.
pub(super) fn whole(reactions: &Reactions) -> Vector2<f64> {
    Vector2::new(-reactions.f0x, -reactions.f0y)
}

/// Tangent angle of the contour whose force on the rod has this direction.
pub(super) fn alpha_of(force: Vector2<f64>) -> f64 {
    force.x.atan2(-force.y)
}

/// The direction of the force on the rod of a contour with this tangent angle.
pub(super) fn push(alpha: f64) -> Vector2<f64> {
    Vector2::new(alpha.sin(), -alpha.cos())
}
