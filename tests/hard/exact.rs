//! A rod on given supports: the problem for the library, and its equations in double-double (32 digits), by an independent
//! integrator.

use super::reference::{advanced, cos_sin};
use std::f64::consts::PI;
use twofloat::TwoFloat;
use vibrissa::Pose;
use vibrissa::rod::{Hold, Support, Supports};

/// What pi is more than its double.
const REST_OF_PI: f64 = 1.224_646_799_147_353_2e-16;

/// A curve that a rod may lie on.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A parabola from its vertex, its tangent angle there, its curvature there; straight where that is 0.
    Bend { vertex: [f64; 2], angle: f64, curvature: f64 },
    /// A convex corner: its parameter is the tangent angle.
    Vertex([f64; 2]),
}

/// A clamped rod and what holds it.
#[derive(Clone, Debug)]
pub struct Problem {
    pub clamp: Pose,
    pub held: Vec<(Shape, Hold)>,
}

impl Supports for Problem {
    fn count(&self) -> usize {
        self.held.len()
    }

    fn hold(&self, j: usize) -> Hold {
        self.held[j].1
    }

    fn support(&self, j: usize, t: f64) -> Support {
        match self.held[j].0 {
            Shape::Vertex([x, y]) => Support { x, y, alpha: t, speed: 0.0, turning: 1.0 },
            Shape::Bend { vertex: [x, y], angle, curvature } => {
                let (sin, cos) = angle.sin_cos();
                let (slope, rise) = (curvature * t, 0.5 * curvature * t * t);
                Support {
                    x: x + t * cos - rise * sin,
                    y: y + t * sin + rise * cos,
                    alpha: angle + slope.atan(),
                    speed: slope.hypot(1.0),
                    turning: curvature / (1.0 + slope * slope),
                }
            }
        }
    }
}

/// A contact in double-double.
struct Contact {
    x: TwoFloat,
    y: TwoFloat,
    phi: TwoFloat,
    cos: TwoFloat,
    sin: TwoFloat,
    force: TwoFloat,
    s: TwoFloat,
}

fn exact(value: f64) -> TwoFloat {
    TwoFloat::from(value)
}

impl Problem {
    fn contact(&self, j: usize, u: &[TwoFloat]) -> Contact {
        let (t, force, third) = (u[3 * j], u[3 * j + 1], u[3 * j + 2]);
        let (x, y, alpha) = match self.held[j].0 {
            Shape::Vertex([x, y]) => (exact(x), exact(y), t),
            Shape::Bend { vertex: [x, y], angle, curvature } => {
                let [cos, sin] = cos_sin(exact(angle));
                let slope = t * curvature;
                let rise = slope * t * 0.5;
                // the arctangent: what the slope is turned back by its double is small
                let guess = f64::from(slope).atan();
                let [c, s] = cos_sin(exact(guess));
                let rest = (slope * c - s) / (slope * s + c);
                (t * cos - rise * sin + x, t * sin + rise * cos + y, exact(angle) + guess + rest)
            }
        };
        let (phi, s) = match self.held[j].1 {
            Hold::Tip => (third, exact(1.0)),
            Hold::Tangent { offset } => {
                let turns = (offset / PI).round();
                (alpha + (exact(PI) + REST_OF_PI) * turns, third)
            }
        };
        let [cos, sin] = cos_sin(alpha);
        Contact { x, y, phi, cos, sin, force, s }
    }

    /// The equations of `MultiPoint` at `u`, and the reactions (f0x, f0y, m0z).
    pub fn residual(&self, u: &[TwoFloat]) -> (Vec<TwoFloat>, [TwoFloat; 3]) {
        let contacts: Vec<_> = (0..self.held.len()).map(|j| self.contact(j, u)).collect();
        let mut residual = vec![exact(0.0); u.len()];
        let [mut a, mut b, mut kappa] = [exact(0.0); 3];
        for (j, at) in contacts.iter().enumerate().rev() {
            if let Some(ahead) = contacts.get(j + 1) {
                kappa = kappa + a * (at.x - ahead.x) + b * (at.y - ahead.y);
            }
            a += at.force * at.cos;
            b += at.force * at.sin;
            let (end, s) = match j.checked_sub(1) {
                None => ([self.clamp.x, self.clamp.y, self.clamp.phi].map(exact), exact(0.0)),
                Some(before) => {
                    let Contact { x, y, phi, s, .. } = contacts[before];
                    ([x, y, phi], s)
                }
            };
            let reached = advanced([at.x, at.y, at.phi, kappa], [a, b], s - at.s);
            for i in 0..3 {
                residual[3 * j + i] = reached[i] - end[i];
            }
        }
        let first = &contacts[0];
        let kappa = kappa + a * (exact(self.clamp.x) - first.x) + b * (exact(self.clamp.y) - first.y);
        (residual, [-b, a, -kappa])
    }
}
