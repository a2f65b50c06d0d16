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

#[cfg(test)]
mod tests {
    use crate::stability::tests::is_held;
    use rod_core::{Guided, Rod};

    /// A column that is built in, runs through a roller at d and carries its load on an end that is free to move across: with p^2 the load and
    /// c = 1 - d the overhang turns by p tan(p c) a moment, the part below resists by p (sin - x cos) / (2 - 2 cos - x sin) with x = p d
    /// (Timoshenko and Gere 1961, chapter 2). It buckles where the two are equal.
    #[test]
    fn a_column_through_a_roller_buckles_at_the_load_of_an_overhang() {
        for d in [0.1_f64, 0.2, 0.5] {
            let c = 1.0 - d;
            let left = |p: f64| {
                let x = p * d;
                let (sin, cos) = x.sin_cos();
                (sin - x * cos) / (2.0 - 2.0 * cos - x * sin) - (p * c).tan()
            };
            let (mut low, mut high) = (1e-2, 0.5 * std::f64::consts::PI / c - 1e-9);
            for _ in 0..100 {
                let p = 0.5 * (low + high);
                if left(p) > 0.0 { low = p } else { high = p }
            }
            let critical = low * low;
            // a roller that does not hold would leave the load of Euler
            assert!(critical > 1.1 * 0.25 * std::f64::consts::PI.powi(2));
            let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), d).unwrap();
            let [less, more] = [0.99 * critical, 1.01 * critical].map(|f| is_held(&rod, 0.0, f));
            assert!(less && !more, "{d}: {critical} {less} {more}");
        }
    }
}
