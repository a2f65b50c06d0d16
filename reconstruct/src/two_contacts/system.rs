//! Least squares over a whole run: reactions, arc lengths and forces as series that obey the conditions of two
//! contacts.

use super::conditions::{INPUTS, ROWS, conditions, second};
use super::series::Series;
use nalgebra::{DMatrix, DVector, Vector2, Vector3};
use rod_core::Dual;

/// Standard deviations of the first two terms of an arc length, which are free, and of the third; the next ones decay
/// by `DECAY` each. Those of a force are in parts of the force at the clamp.
const FREE: [f64; 2] = [1.0, 10.0];
const CURVED: [f64; 2] = [0.03, 0.3];
const DECAY: f64 = 0.5;
/// Standard deviation of the difference of the lengths by which the rod slides past its contacts, halved.
const SLID: f64 = 0.05;

/// One stretch of a run and where its unknowns are: the coefficients of f0x, f0y, m0z (as many terms as the series
/// has), of s1, f1 and, where the second contact is not at the tip, s2 (`terms` each).
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub series: Series,
    pub tip: bool,
    pub terms: usize,
    pub start: usize,
}

/// How tightly the conditions are kept: as a share of their own noise, and absolutely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerance {
    pub share: f64,
    pub floor: f64,
    /// Steps that are made at most.
    pub steps: usize,
}

/// What is known at an end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// Nothing.
    Open,
    /// The second contact goes on: a point of the contour beyond the end, its normal, standard deviation across; the
    /// way of the clamp to there.
    Last { place: Vector2<f64>, normal: Vector2<f64>, sigma: f64, way: f64 },
    /// The first contact goes on, at this arc length.
    First { s: f64, way: f64 },
}

/// Values of everything at one place.
pub(crate) struct Local {
    pub pose: [Vector3<f64>; 2],
    pub values: [f64; INPUTS],
    pub rates: [f64; INPUTS],
    pub basis: [Vec<f64>; 2],
}

impl Part {
    pub fn width(&self) -> usize {
        3 * self.series.terms() + if self.tip { 2 } else { 3 } * self.terms
    }

    /// First column and number of columns of an input.
    fn columns(&self, input: usize) -> (usize, usize) {
        let n = self.series.terms();
        match input {
            0..3 => (self.start + input * n, n),
            5 if self.tip => (0, 0),
            _ => (self.start + 3 * n + (input - 3) * self.terms, self.terms),
        }
    }

    pub fn local(&self, x: &DVector<f64>, t: f64) -> Local {
        let (p, d) = self.series.span.basis(t, self.series.terms().max(self.terms));
        let dot = |b: &[f64], i: usize| {
            let (from, count) = self.columns(i);
            (0..count).map(|j| b[j] * x[from + j]).sum::<f64>()
        };
        let mut values: [f64; INPUTS] = std::array::from_fn(|i| dot(&p, i));
        let rates = std::array::from_fn(|i| dot(&d, i));
        if self.tip {
            values[5] = 1.0;
        }
        let pose = [&p, &d].map(|b| {
            Vector3::from_fn(|c, _| self.series.pose.column(c).iter().zip(b).map(|(m, b)| m * b).sum::<f64>())
        });
        Local { pose, values, rates, basis: [p, d] }
    }

    /// A derivative by the inputs (and their rates) as one by the unknowns.
    fn spread(&self, local: &Local, by: &[f64], row: &mut Vec<(usize, f64)>) {
        for i in 0..INPUTS {
            let (from, count) = self.columns(i);
            for j in 0..count {
                let rate = by.get(INPUTS + i).map_or(0.0, |r| r * local.basis[1][j]);
                row.push((from + j, by[i] * local.basis[0][j] + rate));
            }
        }
    }

    /// Variance of a number with such derivatives by the noise of the reactions.
    fn noise(&self, local: &Local, by: &[f64]) -> f64 {
        let n = self.series.terms();
        (0..3)
            .map(|c| {
                let rate = by.get(INPUTS + c).copied().unwrap_or(0.0);
                let q = DVector::from_fn(n, |j, _| by[c] * local.basis[0][j] + rate * local.basis[1][j]);
                self.series.variance[c] * q.dot(&(&self.series.inverse * &q))
            })
            .sum()
    }

    /// Instants at which the conditions are asked for: Chebyshev's, as many as keep both series.
    fn instants(&self) -> impl Iterator<Item = f64> + use<> {
        let count = self.series.terms().max(self.terms) + 3;
        (0..count).map(move |k| -(std::f64::consts::PI * (k as f64 + 0.5) / count as f64).cos())
    }

    /// Standard deviation of the rate of the first arc length.
    pub fn sigma_of_rate(&self, local: &Local, covariance: &DMatrix<f64>) -> f64 {
        let (from, count) = self.columns(3);
        let rate = DVector::from_fn(count, |j, _| local.basis[1][j]);
        rate.dot(&(covariance.view((from, from), (count, count)) * &rate)).max(0.0).sqrt()
    }

    /// Covariance of the inputs.
    pub fn covariance(&self, local: &Local, inverse: &DMatrix<f64>) -> nalgebra::Matrix6<f64> {
        nalgebra::Matrix6::from_fn(|i, k| {
            let ((a, m), (b, n)) = (self.columns(i), self.columns(k));
            let mut sum = 0.0;
            for u in 0..m {
                for v in 0..n {
                    sum += local.basis[0][u] * inverse[(a + u, b + v)] * local.basis[0][v];
                }
            }
            sum
        })
    }
}

/// Normal equations.
struct Normal {
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
    cost: f64,
}

impl Normal {
    fn add(&mut self, row: &[(usize, f64)], residual: f64, weight: f64) {
        for &(i, a) in row {
            self.gradient[i] += a * weight * residual;
            for &(j, b) in row {
                self.matrix[(i, j)] += a * weight * b;
            }
        }
        self.cost += weight * residual * residual;
    }

    /// The matrix with 1 on its diagonal, and what its rows and columns were multiplied by.
    fn scaled(&self) -> (DVector<f64>, DMatrix<f64>) {
        let scale = self.matrix.diagonal().map(|d| d.max(f64::MIN_POSITIVE).sqrt().recip());
        let n = scale.len();
        let scaled = DMatrix::from_fn(n, n, |i, j| self.matrix[(i, j)] * scale[i] * scale[j]);
        (scale, scaled)
    }
}

/// A run.
pub(crate) struct System<'a> {
    pub parts: &'a [Part],
    pub ends: [End; 2],
    pub tolerance: Tolerance,
}

/// What least squares found.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub x: DVector<f64>,
    pub covariance: DMatrix<f64>,
    pub cost: f64,
}

impl System<'_> {
    /// Weights of the conditions, as they are at x.
    fn weights(&self, x: &DVector<f64>) -> Vec<[f64; ROWS]> {
        let Tolerance { share, floor, .. } = self.tolerance;
        let of = |part: &Part, t| {
            let local = part.local(x, t);
            let rows = conditions(&local.pose, &local.values, &local.rates, part.tip);
            rows.map(|r| 1.0 / (floor * floor + share * share * part.noise(&local, &r.derivatives)))
        };
        self.parts.iter().flat_map(|part| part.instants().map(move |t| of(part, t))).collect()
    }

    fn normal(&self, x: &DVector<f64>, weights: &[[f64; ROWS]]) -> Normal {
        let n = x.len();
        let mut normal = Normal { matrix: DMatrix::zeros(n, n), gradient: DVector::zeros(n), cost: 0.0 };
        let mut weight = weights.iter();
        let mut row = Vec::new();
        for part in self.parts {
            self.measured(part, x, &mut normal);
            Self::slid(part, x, &mut normal);
            let (width, each) = (part.width(), if part.tip { 3 } else { 4 });
            let instants: Vec<f64> = part.instants().collect();
            let mut jacobian = DMatrix::<f64>::zeros(width, each * instants.len());
            let mut residual = DVector::<f64>::zeros(each * instants.len());
            for (k, t) in instants.into_iter().enumerate() {
                let local = part.local(x, t);
                let rows = conditions(&local.pose, &local.values, &local.rates, part.tip);
                let Some(weights) = weight.next() else { return normal };
                for (i, (condition, weight)) in rows.iter().zip(weights).take(each).enumerate() {
                    let (at, scale) = (each * k + i, weight.sqrt());
                    row.clear();
                    part.spread(&local, &condition.derivatives, &mut row);
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

    /// The reactions as they were measured, and what is known beforehand of arc lengths and force: they are smooth.
    fn measured(&self, part: &Part, x: &DVector<f64>, normal: &mut Normal) {
        let series = &part.series;
        for c in 0..3 {
            let (from, n) = part.columns(c);
            let weight = &series.normal / series.variance[c];
            let off = x.rows(from, n) - series.reactions.column(c);
            let pull = &weight * &off;
            normal.cost += off.dot(&pull);
            let mut gradient = normal.gradient.rows_mut(from, n);
            gradient += pull;
            let mut block = normal.matrix.view_mut((from, from), (n, n));
            block += weight;
        }
        let size = series.reactions[(0, 0)].hypot(series.reactions[(0, 1)]);
        for i in 3..INPUTS {
            let (from, n) = part.columns(i);
            let kind = usize::from(i == 4);
            for j in 0..n {
                let sigma = if j < 2 { FREE[kind] } else { CURVED[kind] * DECAY.powi(j as i32 - 2) };
                let sigma = if kind == 1 { sigma * (1.0 + size) } else { sigma };
                let off = if j == 0 && kind == 0 { x[from] - 0.5 } else { x[from + j] };
                normal.add(&[(from + j, 1.0)], off, sigma.powi(-2));
            }
        }
    }

    /// The rod slides past both contacts by nearly the same length.
    fn slid(part: &Part, x: &DVector<f64>, normal: &mut Normal) {
        if !part.tip {
            let (a, b) = (part.columns(3).0 + 1, part.columns(5).0 + 1);
            normal.add(&[(a, -1.0), (b, 1.0)], x[b] - x[a], SLID.powi(-2));
        }
    }

    /// Both contacts and the first force go on from one part to the next.
    fn joint(&self, from: &Part, to: &Part, x: &DVector<f64>, normal: &mut Normal) {
        let way = (to.series.span.centre - to.series.span.half) - (from.series.span.centre + from.series.span.half);
        let (a, b) = (from.local(x, 1.0), to.local(x, -1.0));
        for (input, rate) in [(3, 2.0), (4, 50.0)] {
            let mut row = Vec::new();
            let unit: [f64; INPUTS] = std::array::from_fn(|i| f64::from(u8::from(i == input)));
            from.spread(&a, &unit.map(|u| -u), &mut row);
            to.spread(&b, &unit, &mut row);
            normal.add(
                &row,
                b.values[input] - a.values[input],
                (rate * way.abs() + 1e-6).hypot(self.tolerance.floor).powi(-2),
            );
        }
        let (p, q) = (second(&a.pose[0], &a.values, from.tip), second(&b.pose[0], &b.values, to.tip));
        let Chord { off, by: [by_p, by_q] } = chord(&p, &q);
        let mut row = Vec::new();
        from.spread(&a, &by_p, &mut row);
        to.spread(&b, &by_q, &mut row);
        normal.add(&row, off, across(way, 0.1 * self.tolerance.floor).powi(-2));
    }

    fn end(&self, part: &Part, t: f64, end: End, x: &DVector<f64>, normal: &mut Normal) {
        let local = part.local(x, t);
        let mut row = Vec::new();
        match end {
            End::Open => {}
            End::Last { place, normal: there, sigma, way } => {
                let p = second(&local.pose[0], &local.values, part.tip);
                let fixed = [place.x, place.y, there.x, there.y].map(Dual::constant);
                let Chord { off, by: [_, by] } = chord(&fixed, &p);
                part.spread(&local, &by, &mut row);
                normal.add(&row, off, across(way, sigma.hypot(0.1 * self.tolerance.floor)).powi(-2));
            }
            End::First { s, way } => {
                part.spread(&local, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0], &mut row);
                normal.add(&row, local.values[3] - s, (2.0 * way.abs() + 1e-6).hypot(self.tolerance.floor).powi(-2));
            }
        }
    }

    /// Least squares from x.
    pub fn solve(&self, mut x: DVector<f64>) -> Option<Solution> {
        let mut damping = 1e-3;
        let mut weights = self.weights(&x);
        let mut now = self.normal(&x, &weights);
        let mut settled = 0;
        for _ in 0..self.tolerance.steps {
            if !now.cost.is_finite() {
                return None;
            }
            let (mut next, mut step) = (None, 0.0);
            for _ in 0..10 {
                let (scale, mut scaled) = now.scaled();
                scaled.set_diagonal(&DVector::repeat(x.len(), 1.0 + damping));
                let found = scaled.cholesky().map(|c| c.solve(&now.gradient.component_mul(&scale)));
                if let Some(move_by) = found {
                    let there = &x - move_by.component_mul(&scale);
                    let normal = self.normal(&there, &weights);
                    if normal.cost <= now.cost * (1.0 + 1e-9) {
                        step = move_by.dot(&now.gradient.component_mul(&scale)) / (1.0 + now.cost);
                        next = Some((there, normal));
                        damping = (damping * 0.1).max(1e-14);
                        break;
                    }
                }
                damping = (damping * 10.0).max(1e-4);
            }
            let Some((there, normal)) = next else { break };
            (x, now) = (there, normal);
            if step < 1e-6 {
                settled += 1;
                if settled > 1 {
                    break;
                }
                weights = self.weights(&x);
                now = self.normal(&x, &weights);
            }
        }
        let (scale, scaled) = now.scaled();
        let inverse = scaled.cholesky()?.inverse();
        let covariance = DMatrix::from_fn(x.len(), x.len(), |i, j| inverse[(i, j)] * scale[i] * scale[j]);
        Some(Solution { x, covariance, cost: now.cost })
    }
}

/// By how much the chord from one place of a contact to the next leaves the mean of the two tangents: 0 on a contour, up to
/// the third power of the chord. With derivatives by the inputs at both places.
struct Chord {
    off: f64,
    by: [[f64; INPUTS]; 2],
}

/// The chord between two places, each given as position and normal; the normals may differ in sign.
fn chord(p: &[Dual<f64, INPUTS>; 4], q: &[Dual<f64, INPUTS>; 4]) -> Chord {
    let side = (p[2].value * q[2].value + p[3].value * q[3].value).signum();
    let n = [2, 3].map(|i| 0.5 * (q[i].value + side * p[i].value));
    let chord = [q[0].value - p[0].value, q[1].value - p[1].value];
    let by_q = std::array::from_fn(|i| {
        n[0] * q[0].derivatives[i]
            + n[1] * q[1].derivatives[i]
            + 0.5 * (chord[0] * q[2].derivatives[i] + chord[1] * q[3].derivatives[i])
    });
    let by_p = std::array::from_fn(|i| {
        -n[0] * p[0].derivatives[i] - n[1] * p[1].derivatives[i]
            + 0.5 * side * (chord[0] * p[2].derivatives[i] + chord[1] * p[3].derivatives[i])
    });
    Chord { off: chord[0] * n[0] + chord[1] * n[1], by: [by_p, by_q] }
}

/// Standard deviation of a contact's move across the contour over a way of the clamp, and that of where it starts.
fn across(way: f64, sigma: f64) -> f64 {
    (sigma * sigma + (1e-10 + 10.0 * (3.0 * way).abs().powi(3)).powi(2)).sqrt()
}
