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

/// An iterate counts as the solution where the next correction would be as good as none, radians. It is taken for as much smaller than the
/// last one as that was than the one before it, or, after the first one, for its square.
const SOLVED: f64 = 1e-15;
/// What each correction with an old matrix must shrink to, of the one before it, for that matrix to serve on.
const CONTRACTION: f64 = 0.05;
const MOST_ITERATIONS: usize = 12;
/// Up to these angles (radians) so many terms of the series of sine and versine are exact to rounding.
const SMALL: (f64, usize) = (0.1, 5);
const MODERATE: (f64, usize) = (0.8, 8);

/// 1 / (2 k + 1)! and 1 / (2 k + 2)!
const SERIES: [[f64; 2]; MODERATE.1] = {
    let (mut series, mut k) = ([[1.0, 0.5]; MODERATE.1], 1);
    while k < MODERATE.1 {
        let n = 2.0 * k as f64;
        let sine = series[k - 1][1] / (n + 1.0);
        series[k] = [sine, sine / (n + 2.0)];
        k += 1;
    }
    series
};

/// An element under its load, solved.
pub(super) struct Element {
    /// Length, negative for one that goes to the clamp.
    h: f64,
    force: [f64; 2],
    start: Cut,
    compliance: Values,
    natural: Values,
    /// W by columns; without a force it is left out.
    swing: [Values; NODES],
    cos: Values,
    sin: Values,
    /// f and its derivative by phi.
    pull: Values,
    pull_by_phi: Values,
}

impl Element {
    /// None that has been solved.
    pub const UNSOLVED: Self = Self {
        h: 0.0,
        force: [0.0; 2],
        start: Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 },
        compliance: [0.0; NODES],
        natural: [0.0; NODES],
        swing: [[0.0; NODES]; NODES],
        cos: [0.0; NODES],
        sin: [0.0; NODES],
        pull: [0.0; NODES],
        pull_by_phi: [0.0; NODES],
    };

    /// Makes it the element of length `h` from the cut `start` at `s`. Whether the iteration converged.
    #[inline(never)]
    pub fn solve(&mut self, profile: &impl Profile, s: f64, h: f64, start: &Cut, force: [f64; 2]) -> bool {
        (self.h, self.force, self.start) = (h, force, *start);
        self.compliance = std::array::from_fn(|i| 1.0 / profile.stiffness(s + AT[i] * h));
        self.natural = std::array::from_fn(|i| profile.natural_curvature(s + AT[i] * h));
        let mut unbent = [start.phi; NODES];
        for j in 0..NODES {
            let rate = h * (self.natural[j] + self.compliance[j] * start.moment);
            (0..NODES).for_each(|i| unbent[i] += UP_TO[j][i] * rate);
        }
        let (sin, cos) = start.phi.sin_cos();
        let [pull, pull_by_phi] = [force[0] * cos + force[1] * sin, force[1] * cos - force[0] * sin];
        (self.cos, self.sin) = ([cos; NODES], [sin; NODES]);
        if force == [0.0; 2] {
            self.turn_by(&unbent.map(|phi| phi - start.phi), &unbent);
            return true;
        }
        self.swing();
        // as if the force kept its lever, and then as its lever changes by that
        self.pull = [pull; NODES];
        let turned = self.swung(&unbent).map(|phi| phi - start.phi);
        self.pull = turned.map(|d| pull + d * (pull_by_phi - 0.5 * d * pull));
        let mut phi = self.swung(&unbent);
        self.turn_by(&phi.map(|phi| phi - start.phi), &phi);
        let mut matrix = self.matrix();
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let target = self.swung(&unbent);
            let mut correction: Values = std::array::from_fn(|i| target[i] - phi[i]);
            matrix.solve(&mut correction);
            (0..NODES).for_each(|i| phi[i] += correction[i]);
            let size = self.turn_by(&correction, &phi);
            if size * (size / before).max(size) < SOLVED {
                return true;
            }
            if size.is_nan() || size > 2.0 * before {
                return false;
            }
            if size > CONTRACTION * before {
                matrix = self.matrix();
            }
            before = size;
        }
        false
    }

    #[inline(always)]
    fn swing(&mut self) {
        let weights = self.compliance.map(|compliance| self.h * self.h * compliance);
        for (own, parts) in self.swing.iter_mut().zip(&UP_TO) {
            let mut column = [0.0; NODES];
            for j in 0..NODES {
                let weight = weights[j] * parts[j];
                (0..NODES).for_each(|i| column[i] += UP_TO[j][i] * weight);
            }
            *own = column;
        }
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

    /// Turns the nodes by `angles` to the angles `phi`. Returns the largest |angle|, NaN if one is.
    #[inline(always)]
    fn turn_by(&mut self, angles: &Values, phi: &Values) -> f64 {
        let size = angles.iter().fold(0.0, |most: f64, d| if d.abs() > most || d.is_nan() { d.abs() } else { most });
        if size < SMALL.0 {
            self.turn_by_series::<{ SMALL.1 }>(angles);
        } else if size < MODERATE.0 {
            self.turn_by_series::<{ MODERATE.1 }>(angles);
        } else {
            (0..NODES).for_each(|i| (self.sin[i], self.cos[i]) = phi[i].sin_cos());
        }
        self.pull();
        size
    }

    #[inline(always)]
    fn turn_by_series<const TERMS: usize>(&mut self, angles: &Values) {
        for i in 0..NODES {
            let square = angles[i] * angles[i];
            let (mut sine, mut versine) = (0.0, 0.0);
            for k in (0..TERMS).rev() {
                // 1 - d^2 / (2 3) + .. and 1/2 - d^2 / (2 3 4) + ..
                sine = SERIES[k][0] - square * sine;
                versine = SERIES[k][1] - square * versine;
            }
            let (sine, versine) = (angles[i] * sine, square * versine);
            let (cos, sin) = (self.cos[i], self.sin[i]);
            self.cos[i] = cos - (cos * versine + sin * sine);
            self.sin[i] = sin + (cos * sine - sin * versine);
        }
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
        let (dx, dy) = (h * dot(&WEIGHT, &self.cos), h * dot(&WEIGHT, &self.sin));
        Cut {
            x: start.x + dx,
            y: start.y + dy,
            phi: start.phi + h * dot(&WEIGHT, &self.curvatures()),
            moment: start.moment + (a * dx + b * dy),
        }
    }

    /// The end's changes (what it adds to the position; angle, moment) with the moment at the start of the interval, A and B, which
    /// change angle and moment at the start of the element by `directions`.
    #[inline(always)]
    pub fn changes(&mut self, directions: [[f64; 2]; 3]) -> [[f64; 4]; 3] {
        if self.force == [0.0; 2] {
            self.swing();
        }
        let Self { h, force: [a, b], cos, sin, .. } = &*self;
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

    #[inline(always)]
    fn moments(&self) -> Values {
        let mut moments = [self.start.moment; NODES];
        for k in 0..NODES {
            let rate = self.h * self.pull[k];
            (0..NODES).for_each(|i| moments[i] += UP_TO[k][i] * rate);
        }
        moments
    }

    /// The curvatures at its nodes.
    #[inline(always)]
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
