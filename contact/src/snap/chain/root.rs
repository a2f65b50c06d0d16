//! The root of a chain that runs through a roller.
//!
//! Between clamp and roller a rod is bent little: there it is a beam, built in at the clamp and supported at the roller, which turns at the
//! roller in proportion to the moment there, by M d / 4 E I if it is uniform. The chain is stiff up to the roller and turns about that on a
//! spring of this softness. What the descent finds with it is a guess, as all that it finds.

use super::LINK;
use super::programme::Joints;
use crate::scene::springs::Spring;
use rod_core::{Pose, RodModel, Roller};

/// Midpoints by which the softness of the part between clamp and roller is integrated.
const CELLS: usize = 32;

/// What a roller makes of the root of a chain.
#[derive(Clone, Debug)]
pub(super) struct Root {
    /// Turns everything about the roller.
    pub spring: Spring,
    /// rad along the spring for one of its length.
    pub turn: f64,
    /// Arc length of the roller at rest, and slope angle there, less that of the clamp.
    pub at: f64,
    pub lean: f64,
}

impl Root {
    pub fn new(rod: &impl RodModel, roller: &Roller, pose: Pose) -> Self {
        let [x, y] = roller.point(pose);
        let way = [y - pose.y, pose.x - x, 1.0];
        let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
        // a turn of 1 rad is a way of `length` along the spring
        let softness = softness(rod, roller.at) * length * length;
        let spring = Spring { way: way.map(|w| w / length), softness };
        Self { spring, turn: 1.0 / length, at: roller.at, lean: roller.lean }
    }

    /// Whether the link behind a joint begins before the roller.
    pub fn leads(&self, joint: usize) -> bool {
        (joint as f64) * LINK < self.at
    }

    /// Makes the joints stiff up to the roller.
    pub fn stiffen(&self, softness: &mut Joints) {
        for (i, softness) in softness.iter_mut().enumerate() {
            // a joint stands for half a link on either side
            *softness *= ((i as f64 + 0.5) - self.at / LINK).clamp(0.0, 1.0);
        }
    }
}

/// The turn at the roller, at arc length `at`, by a moment of 1 there.
fn softness(rod: &impl RodModel, at: f64) -> f64 {
    let cells = (0..CELLS).map(|k| {
        let s = at * (k as f64 + 0.5) / CELLS as f64;
        (s / at, (rod.curvature_at(s, 1.0) - rod.natural_curvature(s)) * at / CELLS as f64)
    });
    // moments x and 1 - x times those at roller and clamp, of which the latter keeps the rod on the roller
    let [mut own, mut both, mut far] = [0.0; 3];
    for (x, softness) in cells {
        own += softness * x;
        both += softness * x * (1.0 - x);
        far += softness * (1.0 - x) * (1.0 - x);
    }
    let at_clamp = -both / far;
    // the integral of 1 - x is that of x (1 - x) + (1 - x)^2
    own + at_clamp * (both + far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::Uniform;

    #[test]
    fn a_beam_turns_at_the_roller_by_a_quarter() {
        for at in [0.05, 0.2, 0.7] {
            assert!((softness(&Uniform, at) - 0.25 * at).abs() < 1e-3 * at);
        }
    }
}
