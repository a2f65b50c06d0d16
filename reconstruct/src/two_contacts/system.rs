//! Least squares over a whole run: reactions, arc lengths and forces as series that fulfil the conditions of two contacts.

use super::choice::End;
use super::conditions::{Condition, ContourPoint, TANGENTIAL, WITH_TIP, conditions, second};
use super::part::Part;
use super::unknowns::{Gradient, Unknown, Unknowns};
use super::weights::{self, Tolerance};
use crate::least_squares::{Damped, Iterate, Monotone, NormalMatrix, Problem, Status, iterate};
use crate::point::Inverse;
use nalgebra::{DMatrix, DVector};
use rod_core::Dual;

/// The component of the chord from one place of a contact to the next along the mean of the normals there. On a smooth contour it
/// is of third order in the length of the chord. With derivatives by the unknowns at both places.
pub(super) struct Chord {
    pub across: f64,
    pub by: [Gradient; 2],
}

impl Chord {
    /// From one place to the next; their normals may differ in sign.
    pub fn between(p: &ContourPoint, q: &ContourPoint) -> Self {
        let side = (p.normal[0].value * q.normal[0].value + p.normal[1].value * q.normal[1].value).signum();
        let n = [0, 1].map(|i| 0.5 * (q.normal[i].value + side * p.normal[i].value));
        let chord = [q.x.value - p.x.value, q.y.value - p.y.value];
        let by_q = Unknowns::from_fn(|u| {
            let i = u as usize;
            n[0] * q.x.derivatives[i]
                + n[1] * q.y.derivatives[i]
                + 0.5 * (chord[0] * q.normal[0].derivatives[i] + chord[1] * q.normal[1].derivatives[i])
        });
        let by_p = Unknowns::from_fn(|u| {
            let i = u as usize;
            -n[0] * p.x.derivatives[i] - n[1] * p.y.derivatives[i]
                + 0.5 * side * (chord[0] * p.normal[0].derivatives[i] + chord[1] * p.normal[1].derivatives[i])
        });
        Self { across: chord[0] * n[0] + chord[1] * n[1], by: [by_p, by_q].map(Gradient::of_values) }
    }
}

/// A run of stretches, and how its unknowns are weighted.
pub(super) struct System<'a, I> {
    pub rod: &'a I,
    pub parts: &'a [Part],
    pub ends: [End; 2],
    pub tolerance: Tolerance,
}

/// The least-squares solution: the coefficients, their covariance, and the sum of weighted squares.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub x: DVector<f64>,
    pub covariance: DMatrix<f64>,
    pub cost: f64,
    /// Whether the iteration converged.
    pub converged: bool,
}

impl<I: Inverse> System<'_, I> {
    /// Weights of the conditions at all instants, from their noise at x.
    pub fn weights(&self, x: &DVector<f64>) -> Vec<f64> {
        let Tolerance { share, floor, .. } = self.tolerance;
        let of = |part: &Part, t: f64| -> Vec<f64> {
            let local = part.local(x, t);
            let weight = |c: &Condition| 1.0 / (floor * floor + share * share * part.noise(&local, &c.gradient));
            conditions(self.rod, &local, part.tip).iter().map(weight).collect()
        };
        self.parts.iter().flat_map(|part| part.instants().flat_map(move |t| of(part, t))).collect()
    }

    /// The Gauss-Newton equations at x.
    pub fn normal(&self, x: &DVector<f64>, weights: &[f64]) -> NormalMatrix {
        let mut normal = NormalMatrix::empty(x.len());
        let mut weight = weights.iter();
        let mut row = Vec::new();
        for part in self.parts {
            self.measured(part, x, &mut normal);
            Self::smooth(part, x, &mut normal);
            Self::slid(part, x, &mut normal);
            let (width, each) = (part.width(), if part.tip { WITH_TIP } else { TANGENTIAL });
            let instants: Vec<f64> = part.instants().collect();
            let mut jacobian = DMatrix::<f64>::zeros(width, each * instants.len());
            let mut residual = DVector::<f64>::zeros(each * instants.len());
            for (k, t) in instants.into_iter().enumerate() {
                let local = part.local(x, t);
                let conditions = conditions(self.rod, &local, part.tip);
                for (i, (condition, weight)) in conditions.iter().zip(&mut weight).enumerate() {
                    let (at, scale) = (each * k + i, weight.sqrt());
                    row.clear();
                    part.spread(&local, &condition.gradient, &mut row);
                    let mut column = jacobian.column_mut(at);
                    row.iter().for_each(|&(j, by)| column[j - part.start] = scale * by);
                    residual[at] = scale * condition.value;
                }
            }
            normal.cost += residual.norm_squared();
            normal.gradient.rows_mut(part.start, width).gemv(1.0, &jacobian, &residual, 1.0);
            let transposed = jacobian.transpose();
            normal.matrix.view_mut((part.start, part.start), (width, width)).gemm(1.0, &jacobian, &transposed, 1.0);
        }
        for pair in self.parts.windows(2) {
            self.joint(&pair[0], &pair[1], x, &mut normal);
        }
        if let (Some(first), Some(last)) = (self.parts.first(), self.parts.last()) {
            self.end(first, -1.0, self.ends[0], x, &mut normal);
            self.end(last, 1.0, self.ends[1], x, &mut normal);
        }
        normal
    }

    /// The reactions are as they were measured.
    fn measured(&self, part: &Part, x: &DVector<f64>, normal: &mut NormalMatrix) {
        let series = &part.series;
        for unknown in Unknown::REACTIONS {
            let (from, n) = part.columns(unknown);
            let weight = &series.normal / series.variance[unknown as usize];
            let off = x.rows(from, n) - series.reactions.column(unknown as usize);
            let pull = &weight * &off;
            normal.cost += off.dot(&pull);
            let mut gradient = normal.gradient.rows_mut(from, n);
            gradient += pull;
            let mut block = normal.matrix.view_mut((from, from), (n, n));
            block += weight;
        }
    }

    /// The part of the cost that asks for smoothness.
    pub fn roughness(&self, x: &DVector<f64>) -> f64 {
        let mut normal = NormalMatrix::empty(x.len());
        for part in self.parts {
            Self::smooth(part, x, &mut normal);
            Self::slid(part, x, &mut normal);
        }
        normal.cost
    }

    /// Arc lengths and the first force are smooth.
    fn smooth(part: &Part, x: &DVector<f64>, normal: &mut NormalMatrix) {
        let at_clamp = part.force_at_clamp();
        for unknown in Unknown::CONTACTS {
            let (from, n) = part.columns(unknown);
            for j in 0..n {
                let (mean, sigma) = match unknown {
                    Unknown::F1 => (0.0, weights::force_term(j, at_clamp)),
                    _ if j == 0 => (weights::MEAN_ARC_LENGTH, weights::arc_length_term(j)),
                    _ => (0.0, weights::arc_length_term(j)),
                };
                normal.add(&[(from + j, 1.0)], x[from + j] - mean, sigma);
            }
        }
    }

    /// The rod slides past both contacts by nearly the same length.
    fn slid(part: &Part, x: &DVector<f64>, normal: &mut NormalMatrix) {
        if !part.tip {
            let [a, b] = [Unknown::S1, Unknown::S2].map(|u| part.columns(u).0 + 1);
            normal.add(&[(a, -1.0), (b, 1.0)], x[b] - x[a], weights::SLIDING);
        }
    }

    /// Both contacts and the first force go on from one part to the next.
    fn joint(&self, from: &Part, to: &Part, x: &DVector<f64>, normal: &mut NormalMatrix) {
        let (before, after) = (from.series.interval, to.series.interval);
        let way = (after.centre - after.half) - (before.centre + before.half);
        let floor = self.tolerance.floor;
        let (a, b) = (from.local(x, 1.0), to.local(x, -1.0));
        let steps =
            [(Unknown::S1, weights::arc_length_step(way, floor)), (Unknown::F1, weights::force_step(way, floor))];
        for (unknown, sigma) in steps {
            let mut row = Vec::new();
            let unit = Unknowns::unit(unknown);
            from.spread(&a, &Gradient::of_values(Unknowns(unit.0.map(|u| -u))), &mut row);
            to.spread(&b, &Gradient::of_values(unit), &mut row);
            normal.add(&row, b.values[unknown] - a.values[unknown], sigma);
        }
        let (p, q) = (second(self.rod, &a, from.tip), second(self.rod, &b, to.tip));
        let Chord { across, by: [by_p, by_q] } = Chord::between(&p, &q);
        let mut row = Vec::new();
        from.spread(&a, &by_p, &mut row);
        to.spread(&b, &by_q, &mut row);
        normal.add(&row, across, weights::chord(way, weights::PLACE_SHARE * floor));
    }

    /// The neighbour's single contact goes on as the first or the second one.
    fn end(&self, part: &Part, t: f64, end: End, x: &DVector<f64>, normal: &mut NormalMatrix) {
        let (local, floor) = (part.local(x, t), self.tolerance.floor);
        let mut row = Vec::new();
        match end {
            End::Open => {}
            End::Last { place, normal: there, sigma, way, .. } => {
                let second = second(self.rod, &local, part.tip);
                let [x, y, nx, ny] = [place.x, place.y, there.x, there.y].map(Dual::constant);
                let Chord { across, by: [_, by] } = Chord::between(&ContourPoint { x, y, normal: [nx, ny] }, &second);
                part.spread(&local, &by, &mut row);
                normal.add(&row, across, weights::chord(way, sigma.hypot(weights::PLACE_SHARE * floor)));
            }
            End::First { s, sigma, way, .. } => {
                part.spread(&local, &Gradient::of_values(Unknowns::unit(Unknown::S1)), &mut row);
                normal.add(&row, local.values[Unknown::S1] - s, weights::arc_length_step(way, floor).hypot(sigma));
            }
        }
    }

    /// The solution from a first guess x; none where the equations have no solution.
    ///
    /// First with steps that the natural monotonicity test admits; where that does not converge, with damped ones.
    pub fn solve(&self, x: DVector<f64>) -> Option<Solution> {
        self.gauss_newton(x.clone()).or_else(|| {
            let (at, status) = iterate(&mut Weighted::of(self), x, Damped::default(), self.tolerance.steps);
            if at.equations.cost.is_finite() { Solution::at(at, status == Status::Converged) } else { None }
        })
    }

    /// Sizes of the unknowns, in which the lengths of steps are measured: 1 rod length, and 1 + the force at the clamp.
    fn sizes(&self) -> DVector<f64> {
        let mut sizes = DVector::repeat(self.parts.iter().map(Part::width).sum(), 1.0);
        for part in self.parts {
            let size = 1.0 + part.force_at_clamp();
            for unknown in Unknown::ALL.into_iter().filter(|u| !matches!(u, Unknown::S1 | Unknown::S2)) {
                let (from, count) = part.columns(unknown);
                sizes.rows_mut(from, count).fill(size);
            }
        }
        sizes
    }

    /// By the Gauss-Newton method alone.
    pub fn gauss_newton(&self, x: DVector<f64>) -> Option<Solution> {
        let control = Monotone::with_sizes(self.sizes());
        let (at, status) = iterate(&mut Weighted::of(self), x, control, self.tolerance.steps);
        if status == Status::Converged { Solution::at(at, true) } else { None }
    }
}

/// A system whose weights are renewed once, where the iteration has settled with those of the start.
struct Weighted<'a, 's, I> {
    system: &'a System<'s, I>,
    weights: Vec<f64>,
    /// How often they have been computed.
    times: usize,
}

impl<'a, 's, I> Weighted<'a, 's, I> {
    fn of(system: &'a System<'s, I>) -> Self {
        Self { system, weights: Vec::new(), times: 0 }
    }
}

impl<I: Inverse> Problem for Weighted<'_, '_, I> {
    type Equations = NormalMatrix;

    fn equations(&mut self, x: &DVector<f64>) -> NormalMatrix {
        self.system.normal(x, &self.weights)
    }

    fn reweigh(&mut self, x: &DVector<f64>) -> bool {
        self.times += 1;
        if self.times > 2 {
            return false;
        }
        self.weights = self.system.weights(x);
        true
    }
}

impl Solution {
    fn at(Iterate { x, equations }: Iterate<NormalMatrix>, converged: bool) -> Option<Self> {
        Some(Self { x, covariance: equations.covariance()?, cost: equations.cost, converged })
    }
}
