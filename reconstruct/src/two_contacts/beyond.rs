//! The rod beyond its first contact.

use crate::point::{Clamp, CrossSection, Inverse, normal_part, tangential};

/// Most steps of Newton's method, which converges in 4 to 8 or not at all.
const STEPS: usize = 30;
/// Relative change of the force below which Newton's method has converged: rounding.
const SETTLED: f64 = 1e-14;

/// The rod beyond its first contact: the section there, and the force (A, B) next to the clamp.
pub(super) struct Beyond<'a, I> {
    rod: &'a I,
    s1: f64,
    first: CrossSection,
    pub force: [f64; 2],
    /// Tangent of the angle of friction.
    friction: f64,
}

impl<'a, I: Inverse> Beyond<'a, I> {
    pub fn new(rod: &'a I, clamp: &Clamp, s1: f64) -> Self {
        Self { rod, s1, first: rod.at(clamp, s1), force: clamp.force(), friction: clamp.friction }
    }

    /// The force (A, B) beyond the first contact, which pushes with `f1` from the side of a solid to the left of the rod
    /// (negative: to its right).
    pub fn left(&self, f1: f64) -> [f64; 2] {
        let [a, b] = tangential(f1, self.first.phi.sin_cos(), self.friction);
        [self.force[0] - a, self.force[1] - b]
    }

    /// The tip, and the derivative of how it is bent by f1.
    pub fn tip(&self, f1: f64) -> (CrossSection, f64) {
        let (end, [by_a, by_b]) = self.rod.tip(&self.first, self.s1, self.left(f1));
        let [of_a, of_b] = tangential(1_f64.copysign(f1), self.first.phi.sin_cos(), self.friction);
        let by = -by_a * of_a - by_b * of_b;
        (end, if f1 < 0.0 { -by } else { by })
    }

    /// Whether the tip pushes what it touches, rather than pulls it, where the force there is larger than this.
    pub fn pushes(&self, f1: f64, small: f64) -> bool {
        let (sin, cos) = self.tip(f1).0.phi.sin_cos();
        let [a, b] = normal_part(self.left(f1), (sin, cos), self.friction);
        a * sin - b * cos >= -small
    }

    /// The f1 for which the moment at the tip vanishes, by Newton's method from a guess.
    pub fn force_of_tip(&self, guess: f64) -> Option<f64> {
        let mut f = guess;
        for _ in 0..STEPS {
            let (end, by) = self.tip(f);
            let step = end.bend / by;
            f -= step;
            if !f.is_finite() {
                return None;
            }
            if step.abs() < SETTLED * (1.0 + f.abs()) {
                return Some(f);
            }
        }
        None
    }

    /// Arc length of the next section without moment: the second contact, if that is tangential.
    pub fn second(&self, f1: f64) -> Option<f64> {
        self.rod.next_zero(&self.first, self.s1, self.left(f1))
    }
}
