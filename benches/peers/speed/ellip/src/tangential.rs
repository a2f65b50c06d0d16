//! Phase B, one tangential contact, as one equation for the contact's place on its parabola.
//!
//! With theta = phi0 - alpha the contact lies X = sqrt(2 sin theta / f) along its tangent and Y = int_0^theta sqrt(sin u / 2f) du
//! across it; the former gives the force, the latter is the equation.

use ellip::{StrErr, ellipeinc, ellipf};
use roots::{SimpleConvergency, find_root_brent};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

#[derive(Clone, Copy)]
pub struct Parabola {
    pub vertex: [f64; 2],
    pub coefficient: f64,
}

/// Reactions and the contact, in the order in which they are compared: f0x, f0y, m0z, x, y.
pub type Answer = [f64; 5];

/// int_0^theta sqrt(sin u) du: u = pi/2 - 2 v makes it E(v | 2), and sin v = sin z / sqrt 2 a modulus below 1.
fn root_of_sine(theta: f64) -> Result<f64, StrErr> {
    let second = |z: f64| Ok::<f64, StrErr>(2.0 * ellipeinc(z, 0.5)? - ellipf(z, 0.5)?);
    let z = (SQRT_2 * (FRAC_PI_4 - 0.5 * theta).sin()).asin();
    Ok(SQRT_2 * (second(FRAC_PI_2)? - second(z)?))
}

/// What is known where the contact is at `t` from the vertex.
struct Trial {
    contact: [f64; 2],
    alpha: f64,
    /// Of the clamp, seen from the contact's tangent.
    theta: f64,
    along: f64,
    across: f64,
}

impl Trial {
    fn at(parabola: Parabola, [x, y, phi]: [f64; 3], t: f64) -> Self {
        let Parabola { vertex, coefficient } = parabola;
        let contact = [vertex[0] + t, vertex[1] + coefficient * t * t];
        let alpha = (2.0 * coefficient * t).atan();
        let (sin, cos) = alpha.sin_cos();
        let [dx, dy] = [contact[0] - x, contact[1] - y];
        Self { contact, alpha, theta: phi - alpha, along: dx * cos + dy * sin, across: dy * cos - dx * sin }
    }

    fn force(&self) -> f64 {
        2.0 * self.theta.sin() / (self.along * self.along)
    }

    fn residual(&self) -> f64 {
        // outside of 0 < theta < pi there is no such rod: no sign that Brent's method could use either
        root_of_sine(self.theta).map_or(f64::NAN, |integral| integral / (2.0 * self.force()).sqrt() - self.across)
    }
}

/// From a guess and how far from it a bracket is looked for at first.
pub fn solve(parabola: Parabola, clamp: [f64; 3], guess: f64, reach: f64, tolerance: f64) -> Option<Answer> {
    let residual = |t: f64| Trial::at(parabola, clamp, t).residual();
    let mut reach = reach;
    let (mut low, mut high) = (guess - reach, guess + reach);
    let (mut at_low, mut at_high) = (residual(low), residual(high));
    for _ in 0..6 {
        if at_low * at_high <= 0.0 {
            break;
        }
        reach *= 2.0;
        (low, high) = (guess - reach, guess + reach);
        (at_low, at_high) = (residual(low), residual(high));
    }
    let mut convergency = SimpleConvergency { eps: tolerance, max_iter: 100 };
    let t = find_root_brent(low, high, residual, &mut convergency).ok()?;
    let found = Trial::at(parabola, clamp, t);
    let (f, (sin, cos)) = (found.force(), found.alpha.sin_cos());
    Some([-f * sin, f * cos, f * found.along, found.contact[0], found.contact[1]])
}
