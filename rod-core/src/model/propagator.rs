//! What carries the state of a rod from one place to another: a rod model, an integrator, or a rod of your own.

use crate::error::{RodError, finite};
use crate::segment::Station;

/// What one side of a cut through the rod hands to the other: where it is, where it points, and the bending moment.
/// Dimensionless (lengths in L, moments in E I / L, E I being the reference stiffness of a rod that varies).
///
/// The moment, not the curvature, is what is continuous along a rod: its curvature jumps where its stiffness does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Position along x.
    pub x: f64,
    /// Position along y.
    pub y: f64,
    /// Slope angle, radians, unwrapped along the rod.
    pub phi: f64,
    /// Bending moment; of a uniform straight rod it is the curvature.
    pub moment: f64,
}

/// Carries a [`Cut`] along a rod under a constant force: x' = cos phi, y' = sin phi, m' = A cos phi + B sin phi
/// (Merker et al. 2020, eq. 10, times E I), phi' = the curvature that the rod answers (s, m) with.
///
/// # For users
/// Every [`RodModel`](crate::RodModel) is one; [`Ode`](crate::Ode) takes any law of curvature, and checks the models.
/// [`GeneralElastica`](crate::GeneralElastica) puts point forces on all of them.
///
/// # For rod authors
/// 1. A length of 0 gives the start, exactly.
/// 2. A length in two parts gives what it gives in one.
/// 3. A negative length goes back: there and back again is the start.
/// 4. The moment changes by A dx + B dy (balance of moments).
/// 5. What is not finite is an error, never a panic and never an endless loop.
///
/// 1 and 5 hold exactly, the others within the accuracy of the propagator.
pub trait Propagator {
    /// The cut at arc length `s + length` from the cut `start` at arc length `s`, along a piece that carries the force
    /// (A, B) = (`a`, `b`). All dimensionless.
    ///
    /// # Errors
    /// [`RodError::NotFinite`] for input that is not finite, [`RodError::Integration`] where an integrator gives up.
    fn advance(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Result<Cut, RodError>;

    /// Curvature (1/L) at arc length `s` under the bending moment `moment`; the moment itself for a uniform straight rod.
    fn curvature(&self, _s: f64, moment: f64) -> f64 {
        moment
    }
}

impl From<&Cut> for Station {
    fn from(&Cut { x, y, phi, moment }: &Cut) -> Self {
        let (sin, cos) = phi.sin_cos();
        Self { x, y, cos, sin, moment }
    }
}

impl Cut {
    /// Rule 5 for a cut.
    pub(crate) fn check(&self) -> Result<(), RodError> {
        finite("x", self.x)?;
        finite("y", self.y)?;
        finite("phi", self.phi)?;
        finite("moment", self.moment)
    }
}

/// Rule 5 for what goes into a propagator.
pub(crate) fn check(s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Result<(), RodError> {
    finite("arc length", s)?;
    start.check()?;
    finite("A", a)?;
    finite("B", b)?;
    finite("length", length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judges::{Method, Ode};
    use crate::model::Uniform;
    use proptest::prelude::*;

    fn distance(u: &Cut, v: &Cut) -> f64 {
        [u.x - v.x, u.y - v.y, u.phi - v.phi, u.moment - v.moment].into_iter().fold(0.0, |m, e| m.max(e.abs()))
    }

    fn propagators() -> Vec<(Box<dyn Propagator>, f64)> {
        vec![
            (Box::new(Uniform), 1e-12),
            (Box::new(Ode::uniform(Method::Dop853, 1e-13).unwrap()), 1e-9),
            (Box::new(Ode::with_law(|s, m| 0.5 + m * (1.0 + s), Method::Dopri5, 1e-12).unwrap()), 1e-8),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn rules_1_to_4(
            phi in -3.2..3.2, moment in -4.0..4.0, a in -8.0..8.0, b in -8.0..8.0, from in 0.0..0.5, l1 in 0.0..0.5, l2 in -0.5..0.5,
        ) {
            let start = Cut { x: 0.1, y: -0.2, phi, moment };
            for (rod, tolerance) in propagators() {
                prop_assert_eq!(rod.advance(from, &start, a, b, 0.0).unwrap(), start, "rule 1");
                let half = rod.advance(from, &start, a, b, l1).unwrap();
                let parts = rod.advance(from + l1, &half, a, b, l2).unwrap();
                let whole = rod.advance(from, &start, a, b, l1 + l2).unwrap();
                prop_assert!(distance(&parts, &whole) < tolerance, "rule 2: {:e}", distance(&parts, &whole));
                let back = rod.advance(from + l1, &half, a, b, -l1).unwrap();
                prop_assert!(distance(&back, &start) < tolerance, "rule 3: {:e}", distance(&back, &start));
                let balance = whole.moment - moment - a * (whole.x - start.x) - b * (whole.y - start.y);
                prop_assert!(balance.abs() < tolerance, "rule 4: {balance:e}");
            }
        }
    }

    #[test]
    fn rule_5() {
        let good = [0.0, 0.0, 0.0, 0.3, 1.0, 2.0, 3.0, 0.5];
        for (rod, _) in propagators() {
            for i in 0..good.len() {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut v = good;
                    v[i] = bad;
                    let [s, x, y, phi, moment, a, b, length] = v;
                    let result = rod.advance(s, &Cut { x, y, phi, moment }, a, b, length);
                    assert!(matches!(result, Err(RodError::NotFinite { .. })), "{i} {bad}");
                }
            }
        }
    }
}
