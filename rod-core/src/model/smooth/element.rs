//! One element: the boundary-value problem's differential equation by collocation at Gauss points.
//!
//! With g = 1 / EI, k = kappa0 and f = A cos phi + B sin phi at the nodes, a the tableau and h the length:
//!
//! ```text
//! phi_i = phi_0 + h sum_j a_ij (k_j + g_j m_0) + sum_k W_ik f_k,   W_ik = h^2 sum_j a_ij g_j a_jk
//! ```
//!
//! Newton's matrix, with entries delta_ik - W_ik f'_k, is that of the derivatives too.

#![expect(
    clippy::needless_range_loop,
    reason = "small arrays that are indexed alike, in loops that the compiler unrolls"
)]

use super::gauss::{AT, NODES, UP_TO, WEIGHT};
use crate::model::Cut;
use crate::model::profile::Profile;

pub(super) type Values = [f64; NODES];

/// An iterate counts as the solution where the next correction (radians) is as good as none: the one after it would be its square.
const SOLVED: f64 = 1e-13;
/// What each correction with an old matrix must shrink to, of the one before it, for that matrix to serve on.
const CONTRACTION: f64 = 0.05;
const MOST_ITERATIONS: usize = 12;
/// Up to here the series of sine and cosine are exact to rounding, radians.
const SMALL: f64 = 0.1;

/// An element under its load, solved.
pub(super) struct Element {
    /// Length, negative for one that goes to the clamp.
    h: f64,
    force: [f64; 2],
    start: Cut,
    compliance: Values,
    natural: Values,
    /// W by columns.
    swing: [Values; NODES],
    cos: Values,
    sin: Values,
    /// f and its derivative by phi.
    pull: Values,
    pull_by_phi: Values,
}

impl Element {
    /// The element of length `h` from the cut `start` at `s`. None where the iteration does not converge.
    #[inline]
    pub fn solve(profile: &impl Profile, s: f64, h: f64, start: &Cut, force: [f64; 2]) -> Option<Self> {
        let zero = [0.0; NODES];
        let compliance: Values = std::array::from_fn(|i| 1.0 / profile.stiffness(s + AT[i] * h));
        let natural: Values = std::array::from_fn(|i| profile.natural_curvature(s + AT[i] * h));
        let mut swing = [zero; NODES];
        for (column, parts) in swing.iter_mut().zip(&UP_TO) {
            for j in 0..NODES {
                let weight = h * h * compliance[j] * parts[j];
                (0..NODES).for_each(|i| column[i] += UP_TO[j][i] * weight);
            }
        }
        let mut unbent = [start.phi; NODES];
        for j in 0..NODES {
            let rate = h * (natural[j] + compliance[j] * start.moment);
            (0..NODES).for_each(|i| unbent[i] += UP_TO[j][i] * rate);
        }
        let (sin, cos) = start.phi.sin_cos();
        let mut element = Self {
            h,
            force,
            start: *start,
            compliance,
            natural,
            swing,
            cos: zero,
            sin: zero,
            pull: [force[0] * cos + force[1] * sin; NODES],
            pull_by_phi: zero,
        };
        // as if the force kept its lever
        let mut phi = element.swung(&unbent);
        element.turn_to(&phi);
        let mut matrix = element.matrix();
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let target = element.swung(&unbent);
            let mut correction: Values = std::array::from_fn(|i| target[i] - phi[i]);
            matrix.solve(&mut correction);
            let size =
                correction.iter().fold(0.0, |most: f64, d| if d.abs() > most || d.is_nan() { d.abs() } else { most });
            (0..NODES).for_each(|i| phi[i] += correction[i]);
            element.turn_by(&correction, size, &phi);
            if size < SOLVED {
                return Some(element);
            }
            if size.is_nan() || size > 2.0 * before {
                return None;
            }
            if size > CONTRACTION * before {
                matrix = element.matrix();
            }
            before = size;
        }
        None
    }

    /// The angles that the force gives the nodes.
    #[inline(always)]
    fn swung(&self, unbent: &Values) -> Values {
        let mut phi = *unbent;
        for (column, pull) in self.swing.iter().zip(&self.pull) {
            (0..NODES).for_each(|i| phi[i] += column[i] * pull);
        }
        phi
    }

    #[inline(always)]
    fn turn_to(&mut self, phi: &Values) {
        for i in 0..NODES {
            (self.sin[i], self.cos[i]) = phi[i].sin_cos();
        }
        self.pull();
    }

    /// Turns the nodes by small angles to the angles `phi`.
    #[inline(always)]
    fn turn_by(&mut self, angles: &Values, size: f64, phi: &Values) {
        if size >= SMALL || size.is_nan() {
            return self.turn_to(phi);
        }
        for i in 0..NODES {
            let (d, square) = (angles[i], angles[i] * angles[i]);
            let sine = d
                * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0 - square / 362_880.0))));
            let versine = square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40_320.0)));
            let (cos, sin) = (self.cos[i], self.sin[i]);
            self.cos[i] = cos - (cos * versine + sin * sine);
            self.sin[i] = sin + (cos * sine - sin * versine);
        }
        self.pull();
    }

    #[inline(always)]
    fn pull(&mut self) {
        let [a, b] = self.force;
        self.pull = std::array::from_fn(|i| a * self.cos[i] + b * self.sin[i]);
        self.pull_by_phi = std::array::from_fn(|i| b * self.cos[i] - a * self.sin[i]);
    }

    #[inline(always)]
    fn matrix(&self) -> Matrix {
        Matrix::new(std::array::from_fn(|k| {
            let mut column: Values = std::array::from_fn(|i| -self.swing[k][i] * self.pull_by_phi[k]);
            column[k] += 1.0;
            column
        }))
    }

    /// What the moment takes from the pull at each node to the turn of the end, and from the moment at the start.
    #[inline(always)]
    fn turn_of_end(&self) -> (Values, f64) {
        let weights: Values = std::array::from_fn(|i| self.h * WEIGHT[i] * self.compliance[i]);
        let by_pull = std::array::from_fn(|k| self.h * dot(&weights, &UP_TO[k]));
        (by_pull, weights.iter().sum())
    }

    /// The cut where it ends.
    #[inline(always)]
    pub fn end(&self) -> Cut {
        let Self { h, force: [a, b], start, .. } = self;
        let (by_pull, by_moment) = self.turn_of_end();
        let (dx, dy) = (h * dot(&WEIGHT, &self.cos), h * dot(&WEIGHT, &self.sin));
        Cut {
            x: start.x + dx,
            y: start.y + dy,
            phi: start.phi + h * dot(&WEIGHT, &self.natural) + by_moment * start.moment + dot(&by_pull, &self.pull),
            moment: start.moment + (a * dx + b * dy),
        }
    }

    /// The end's changes (what it adds to the position; angle, moment) with the moment at the start of the interval, A and B, which
    /// change angle and moment at the start of the element by `directions`.
    #[inline(always)]
    pub fn changes(&self, directions: [[f64; 2]; 3]) -> [[f64; 4]; 3] {
        let Self { h, force: [a, b], cos, sin, .. } = self;
        let matrix = self.matrix();
        let (by_pull, by_moment) = self.turn_of_end();
        let mut by_start_moment = [0.0; NODES];
        for j in 0..NODES {
            let rate = h * self.compliance[j];
            (0..NODES).for_each(|i| by_start_moment[i] += UP_TO[j][i] * rate);
        }
        let (dx, dy) = (h * dot(&WEIGHT, cos), h * dot(&WEIGHT, sin));
        let own = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        std::array::from_fn(|n| {
            let ([phi, moment], [by_a, by_b]) = (directions[n], own[n]);
            let mut turns: Values = std::array::from_fn(|i| phi + moment * by_start_moment[i]);
            let lever: Values = std::array::from_fn(|k| by_a * cos[k] + by_b * sin[k]);
            for (column, pull) in self.swing.iter().zip(&lever) {
                (0..NODES).for_each(|i| turns[i] += column[i] * pull);
            }
            matrix.solve(&mut turns);
            let pull: Values = std::array::from_fn(|k| lever[k] + self.pull_by_phi[k] * turns[k]);
            let moved: [f64; 2] = [
                -h * (0..NODES).map(|i| WEIGHT[i] * sin[i] * turns[i]).sum::<f64>(),
                h * (0..NODES).map(|i| WEIGHT[i] * cos[i] * turns[i]).sum::<f64>(),
            ];
            let [x, y] = moved;
            [x, y, phi + by_moment * moment + dot(&by_pull, &pull), moment + a * x + b * y + by_a * dx + by_b * dy]
        })
    }

    /// Where its nodes are, if it starts at `s`.
    pub fn nodes(&self, s: f64) -> Values {
        AT.map(|part| s + part * self.h)
    }

    /// The cut where it begins.
    pub fn start(&self) -> Cut {
        self.start
    }

    fn moments(&self) -> Values {
        let mut moments = [self.start.moment; NODES];
        for k in 0..NODES {
            (0..NODES).for_each(|i| moments[i] += self.h * UP_TO[k][i] * self.pull[k]);
        }
        moments
    }

    /// The curvatures at its nodes.
    pub fn curvatures(&self) -> Values {
        let moments = self.moments();
        std::array::from_fn(|i| moments[i] * self.compliance[i] + self.natural[i])
    }

    /// 1/2 int m^2 / EI ds.
    pub fn bending_energy(&self) -> f64 {
        let moments = self.moments();
        let density: Values = std::array::from_fn(|i| moments[i] * moments[i] * self.compliance[i]);
        0.5 * self.h * dot(&WEIGHT, &density)
    }
}

#[inline(always)]
fn dot(u: &Values, v: &Values) -> f64 {
    u.iter().zip(v).map(|(u, v)| u * v).sum()
}

/// A matrix near the unit matrix, factorised without pivoting, by columns.
struct Matrix {
    columns: [Values; NODES],
    inverse_pivots: Values,
}

impl Matrix {
    #[inline(always)]
    fn new(mut columns: [Values; NODES]) -> Self {
        let mut inverse_pivots = [0.0; NODES];
        for k in 0..NODES {
            let inverse = 1.0 / columns[k][k];
            inverse_pivots[k] = inverse;
            for i in k + 1..NODES {
                columns[k][i] *= inverse;
            }
            let pivotal = columns[k];
            for column in &mut columns[k + 1..] {
                let factor = column[k];
                for i in k + 1..NODES {
                    column[i] -= pivotal[i] * factor;
                }
            }
        }
        Self { columns, inverse_pivots }
    }

    #[inline(always)]
    fn solve(&self, x: &mut Values) {
        for k in 0..NODES {
            let known = x[k];
            for i in k + 1..NODES {
                x[i] -= self.columns[k][i] * known;
            }
        }
        for k in (0..NODES).rev() {
            x[k] *= self.inverse_pivots[k];
            let known = x[k];
            for i in 0..k {
                x[i] -= self.columns[k][i] * known;
            }
        }
    }
}
