//! A boundary-value problem of the reference set: what holds the rod, its solution, and how wrong another one is.

use crate::problem::{Holds, Problem, Shape};
use std::f64::consts::PI;
use vibrissa::contour::Frame;
use vibrissa::rod::{Hold, MultiPoint, Support, Supports, Uniform};
use vibrissa::{Contour, Parabola, Pose};

/// Supports of all the shapes of the reference set, each with a parameter of its own: x from the vertex of a parabola, the
/// tangent angle on a circle and at a corner, the way along a line.
pub struct Held {
    contacts: Vec<(Shape, Hold)>,
}

impl Supports for Held {
    fn count(&self) -> usize {
        self.contacts.len()
    }

    fn hold(&self, j: usize) -> Hold {
        self.contacts[j].1
    }

    fn support(&self, j: usize, t: f64) -> Support {
        let (sin, cos) = t.sin_cos();
        match self.contacts[j].0 {
            Shape::Parabola { vertex, coefficient } => {
                let frame = Parabola::new(vertex, coefficient).map(|parabola| parabola.frame(t));
                let Frame { x, y, alpha, speed, turning } = frame.unwrap();
                Support { x, y, alpha, speed, turning }
            }
            Shape::Circle { centre: [x, y], radius } => {
                Support { x: x + radius * sin, y: y - radius * cos, alpha: t, speed: radius, turning: 1.0 }
            }
            Shape::Line { point: [x, y], angle } => {
                let (sin, cos) = angle.sin_cos();
                Support { x: x + t * cos, y: y + t * sin, alpha: angle, speed: 1.0, turning: 0.0 }
            }
            Shape::Vertex { point: [x, y] } => Support { x, y, alpha: t, speed: 0.0, turning: 1.0 },
        }
    }
}

/// A boundary-value problem with its true solution.
pub struct Case<'a> {
    pub problem: &'a Problem,
    pub supports: Held,
    pub clamp: Pose,
    /// The true unknowns, rounded.
    pub solution: Vec<f64>,
}

impl<'a> Case<'a> {
    pub fn new(problem: &'a Problem) -> Self {
        let (mut contacts, mut solution) = (Vec::new(), Vec::new());
        for touch in &problem.contacts {
            let shape = problem.supports[touch.support.unwrap()];
            let (x, y, alpha) = (touch.x.hi, touch.y.hi, touch.alpha.hi);
            let t = match shape {
                // near a sharp vertex the second double counts
                Shape::Parabola { vertex, .. } => (x - vertex[0]) + touch.x.lo,
                Shape::Circle { .. } | Shape::Vertex { .. } => alpha,
                Shape::Line { point, angle } => (x - point[0]) * angle.cos() + (y - point[1]) * angle.sin(),
            };
            let (hold, third) = match touch.hold {
                Holds::Tangent => (Hold::Tangent { offset: f64::from(touch.turns) * PI }, touch.s.hi),
                Holds::Tip | Holds::Notch => (Hold::Tip, touch.phi.hi),
            };
            contacts.push((shape, hold));
            solution.extend([t, touch.force.hi, third]);
        }
        Self { problem, supports: Held { contacts }, clamp: problem.pose(), solution }
    }

    /// The same rod on the same supports, its clamp elsewhere.
    pub fn clamped(&self, clamp: Pose) -> MultiPoint<'_, Held> {
        MultiPoint { rod: Uniform, clamp, supports: &self.supports }
    }

    /// Largest error of the reactions and of the points of contact.
    pub fn error(&self, u: &[f64]) -> f64 {
        let (mut f0x, mut f0y) = (0.0, 0.0);
        let mut errors = Vec::new();
        for (j, touch) in self.problem.contacts.iter().enumerate() {
            let (at, force) = (self.supports.support(j, u[3 * j]), u[3 * j + 1]);
            let (sin, cos) = at.alpha.sin_cos();
            (f0x, f0y) = (f0x - force * sin, f0y + force * cos);
            errors.extend([touch.x.error(at.x), touch.y.error(at.y)]);
        }
        let truth = self.problem.reactions.unwrap();
        let m0z = -self.clamped(self.clamp).clamp_curvature(u);
        errors.extend([truth.f0x.error(f0x), truth.f0y.error(f0y), truth.m0z.error(m0z)]);
        largest(errors)
    }
}

/// The largest of errors; what is no number is larger than all others.
pub fn largest(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
}
