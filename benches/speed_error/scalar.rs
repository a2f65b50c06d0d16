//! Phase B as one equation in one unknown, for Brent's method.
//!
//! Where the contact is (t) says which way the force acts; the first integral of the elastica, zero at a tangential contact, and
//! the balance of moments then say how strong it is and how the rod leaves its clamp; it ends where it is straight, and
//! must be on the contour there. Across the contour this is the equation that is left, along it it holds by balance.
//! In phase A two unknowns stay, for the arc length is given and the angle free: that is no problem for Brent's method.

use crate::held::Case;
use vibrissa::rod::{Hold, RodError, Section, Supports, advance, find_root, inflection};

/// How often a bracket is widened, to twice its width.
const WIDENED: u32 = 10;

#[derive(Clone)]
pub struct Scalar<'a> {
    case: &'a Case<'a>,
}

impl<'a> Scalar<'a> {
    /// None where there is not one tangential contact.
    pub fn of(case: &'a Case<'a>) -> Option<Self> {
        let single = case.supports.count() == 1 && matches!(case.supports.hold(0), Hold::Tangent { .. });
        single.then_some(Self { case })
    }

    /// Force and arc length with the contact at `t`, and how far off the contour the rod ends.
    fn at(&self, t: f64) -> Option<(f64, f64, f64)> {
        let (clamp, at) = (self.case.clamp, self.case.supports.support(0, t));
        let (sin, cos) = at.alpha.sin_cos();
        let arm = (at.x - clamp.x) * cos + (at.y - clamp.y) * sin;
        let force = 2.0 * (clamp.phi - at.alpha).sin() / (arm * arm);
        // also where it is no number
        if force.is_nan() || force <= 0.0 {
            return None;
        }
        let start = Section { x: clamp.x, y: clamp.y, phi: clamp.phi, kappa: -force * arm };
        let (a, b) = (force * cos, force * sin);
        let s = inflection(&start, a, b)?;
        let end = advance(&start, a, b, s);
        Some((force, s, (end.y - at.y) * cos - (end.x - at.x) * sin))
    }

    /// The unknowns near a guess: a change of sign is looked for farther and farther from it.
    pub fn solve(&self, u: &mut [f64], reach: f64, tolerance: f64) -> bool {
        let off = |t: f64| {
            let (_, _, off) = self.at(t).ok_or(RodError::NotFinite { what: "force", value: f64::NAN })?;
            Ok(off)
        };
        let ends = (0..WIDENED).map(|k| reach * f64::from(1 << k)).map(|reach| (u[0] - reach, u[0] + reach));
        let changes = |&(from, to): &(f64, f64)| matches!((off(from), off(to)), (Ok(a), Ok(b)) if a * b <= 0.0);
        let Some((from, to)) = ends.into_iter().find(changes) else { return false };
        let Ok(root) = find_root("distance from the contour", off, from, to, tolerance) else { return false };
        let Some((force, s, _)) = self.at(root.at) else { return false };
        u.copy_from_slice(&[root.at, force, s]);
        true
    }
}
