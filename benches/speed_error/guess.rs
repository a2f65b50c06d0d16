//! What a solve starts from.

use crate::held::Case;
use crate::problem::{Holds, Shape};
use std::f64::consts::{FRAC_PI_2, TAU};
use vibrissa::Pose;
use vibrissa::rod::{NewtonOptions, NewtonWorkspace, Supports, solve};

/// How far the clamp is moved for a warm start, and in how many directions, so that no branch predictor learns one solve by
/// heart.
const MOVED: f64 = 1e-3;
const DIRECTIONS: u32 = 8;

/// Where solves start, all of which lead to the same solution; and how far a search in the first unknown goes at first.
pub struct Start {
    pub guesses: Vec<Vec<f64>>,
    pub reach: f64,
}

impl Start {
    /// From the solutions with the clamp moved.
    pub fn warm(case: &Case<'_>) -> Self {
        let options = NewtonOptions::default();
        let moved = |k: u32| {
            let (sin, cos) = (f64::from(k) * TAU / f64::from(DIRECTIONS)).sin_cos();
            let clamp = Pose { x: case.clamp.x + MOVED * cos, y: case.clamp.y + MOVED * sin, ..case.clamp };
            let mut u = case.solution.clone();
            let report = solve(&case.clamped(clamp), &mut u, &options, &mut NewtonWorkspace::new());
            report.status.is_solved().then_some(u)
        };
        Self { guesses: (0..DIRECTIONS).filter_map(moved).collect(), reach: MOVED }
    }

    /// As one reads it off a sketch: the parameters of the contacts to a tenth (of the rod's length, or radians), the forces to a
    /// power of two, arc lengths along the chords from contact to contact, the angle of the tip along the last of them.
    pub fn cold(case: &Case<'_>) -> Self {
        let (mut u, mut s) = (case.solution.clone(), 0.0);
        let mut at = (case.clamp.x, case.clamp.y);
        let tenth = |t: f64| (10.0 * t).round() / 10.0;
        for (j, touch) in case.problem.contacts.iter().enumerate() {
            let shift = match case.problem.supports[touch.support.unwrap()] {
                Shape::Circle { .. } => FRAC_PI_2,
                _ => 0.0,
            };
            u[3 * j] = tenth(u[3 * j] - shift) + shift;
            u[3 * j + 1] = u[3 * j + 1].log2().round().exp2();
            let support = case.supports.support(j, u[3 * j]);
            let chord = (support.x - at.0, support.y - at.1);
            s += chord.0.hypot(chord.1);
            u[3 * j + 2] = if touch.hold == Holds::Tip { chord.1.atan2(chord.0) } else { s };
            at = (support.x, support.y);
        }
        Self { guesses: vec![u], reach: 0.05 }
    }
}
