//! The second variation at a roller, over which the rod slides.
//!
//! The point of the rod at the roller moves by u along the rod and stays on the roller: the same as at a vertex of a contour, v = 0 and
//! w = 1, that the rod lies on. Its second-order condition is g = 2 eta u - kappa u^2 = 0, with the Lagrange multiplier R of either sign.

use super::Form;
use crate::gap::shape::Shape;
use rod_core::{RodModel, Support};

/// The roller of a rod that runs through one, under load, as a contour: a vertex in the direction of the rod.
pub(super) fn support(shape: &Shape) -> Support {
    let at = &shape.segments[1].start;
    Support { x: at.x, y: at.y, alpha: at.phi, speed: 0.0, turning: 1.0 }
}

/// What it adds to the second variation: -R g.
pub(super) fn form(rod: &impl RodModel, shape: &Shape) -> Form {
    let [before, behind] = [&shape.segments[0], &shape.segments[1]];
    let (sin, cos) = behind.start.phi.sin_cos();
    let force = (before.a - behind.a) * cos + (before.b - behind.b) * sin;
    let kappa = rod.curvature_at(behind.s, behind.start.moment);
    Form::Moves([force * kappa, -force, 0.0])
}
