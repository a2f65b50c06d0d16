//! Where the rod passes next to a run: no contact may be there.
//!
//! The shape of a rod with one contact or none is known. As long as it comes by a point with its middle, and not with its tip, it has
//! stayed on one side of what is solid there.

use super::conditions::two;
use super::part::Part;
use super::system::Solution;
use super::unknowns::Unknown;
use crate::phase::Label;
use crate::point::{Clamp, Inverse, RodInterval};
use nalgebra::{Vector2, Vector3};

/// Straight pieces in place of a rod. They leave it by an eighth of the square of their length times its curvature.
const PIECES: usize = 24;
/// Shapes on each side of a run.
const MOST_SHAPES: usize = 200;
/// Arc lengths between which the rod comes by with its middle, rod lengths. Beyond them it may have gone round the point.
const MIDDLE: (f64, f64) = (0.05, 0.85);
/// How far the rod is beyond a point that it contradicts, rod lengths, besides the deviations of the point: the error of its shape.
const MARGIN: f64 = 0.02;
const SIGMAS: f64 = 6.0;
/// Instants of a part that are compared.
const INSTANTS: usize = 9;
/// A force below this share of that at the clamp does not tell the side of the solid.
const SMALL: f64 = 0.05;

type Shape = [Vector2<f64>; PIECES + 1];

/// Shapes of the rod before and after a run, those next to it first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Passed {
    sides: [Vec<Shape>; 2],
}

impl Passed {
    /// From the clamps and labels of stretches with one contact or none on each side of a run, those next to it first.
    pub fn new<I: Inverse>(rod: &I, sides: [Vec<(Clamp, Label)>; 2]) -> Self {
        let shapes = |clamps: Vec<(Clamp, Label)>| {
            let step = clamps.len().div_ceil(MOST_SHAPES).max(1);
            clamps.into_iter().step_by(step).filter_map(|(clamp, label)| shape(rod, &clamp, label)).collect()
        };
        Self { sides: sides.map(shapes) }
    }

    /// Whether the rod comes by beyond the first contact of a part.
    pub(super) fn contradict<I: Inverse>(&self, rod: &I, part: &Part, solution: &Solution) -> bool {
        if self.sides.iter().all(Vec::is_empty) {
            return false;
        }
        let small = SMALL * (1.0 + part.force_at_clamp());
        (0..INSTANTS).any(|k| {
            let local = part.local(&solution.x, -1.0 + 2.0 * (k as f64 + 0.5) / INSTANTS as f64);
            let (s1, f1) = (local.values[Unknown::S1], local.values[Unknown::F1]);
            if s1 > MIDDLE.1 || f1.abs() < small {
                return false;
            }
            let first = two(rod, &local).first;
            let covariance = part.covariance(&local, &solution.covariance);
            let sigma = covariance[(Unknown::S1 as usize, Unknown::S1 as usize)].max(0.0).sqrt();
            let (at, along) = (Vector2::new(first.x, first.y), Vector2::new(first.phi.cos(), first.phi.sin()));
            // the point may be anywhere along the rod within its noise
            let ends = [-SIGMAS, SIGMAS].map(|n| at + along * (n * sigma));
            self.sides.iter().any(|shapes| ends.iter().chain([&at]).all(|at| passes(shapes, *at, f1.signum())))
        })
    }
}

/// Whether a rod is farther to the solid's side (1: its left, -1: its right) than the point, before its tip comes by.
fn passes(shapes: &[Shape], at: Vector2<f64>, side: f64) -> bool {
    for shape in shapes {
        let (s, left) = nearest(shape, at);
        if !(MIDDLE.0..MIDDLE.1).contains(&s) {
            return false;
        }
        if side * left < -MARGIN {
            return true;
        }
    }
    false
}

/// Arc length of the place nearest to a point, and how far the point is on the left of the rod.
fn nearest(shape: &Shape, at: Vector2<f64>) -> (f64, f64) {
    let piece = |k: usize| {
        let way = shape[k + 1] - shape[k];
        let off = at - shape[k];
        let share = (off.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        ((off - way * share).norm(), (k as f64 + share) / PIECES as f64, way.perp(&off) / way.norm())
    };
    let best = (0..PIECES).map(piece).fold((f64::INFINITY, 0.0, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    (best.1, best.0.copysign(best.2))
}

/// The shape of a rod with one contact or none, beyond which it is as at rest.
fn shape<I: Inverse>(rod: &I, clamp: &Clamp, label: Label) -> Option<Shape> {
    let free = Clamp { reactions: Vector3::zeros(), ..*clamp };
    let (clamp, end) = match label {
        Label::Free => (&free, 1.0),
        _ => (clamp, rod.first(clamp).ok()?.s.min(1.0)),
    };
    let last = rod.at(clamp, end);
    let points = std::array::from_fn(|k| {
        let s = k as f64 / PIECES as f64;
        if s <= end {
            let section = rod.at(clamp, s);
            return Vector2::new(section.x, section.y);
        }
        let section = rod.carry(&last, &RodInterval { from: end, to: s, force: [0.0; 2] });
        Vector2::new(section.x, section.y)
    });
    points.iter().all(|point: &Vector2<f64>| point.x.is_finite() && point.y.is_finite()).then_some(points)
}
