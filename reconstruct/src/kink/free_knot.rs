//! Place and size of a transition: least squares with a free knot, on samples or on bins of them.

use super::transition::KinkKind;
use crate::numeric::NormalEquations;
use nalgebra::{SMatrix, SVector};

/// A transition placed between samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FittedTransition {
    pub kind: KinkKind,
    pub tau: f64,
    pub sigma_tau: f64,
    /// First sample after it.
    pub next: usize,
    /// Changes of slope, or of value, and their standard deviations.
    pub change: [f64; 3],
    pub sigma: [f64; 3],
}

/// Samples, or bins of them, and their white-equivalent noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnotData<'a> {
    pub tau: &'a [f64],
    pub channels: [&'a [f64]; 3],
    pub sigma: [f64; 3],
}

/// Most moves of the knot (Gauss-Newton steps). It settles in 3 to 5 where there is a kink.
const MOVES: usize = 12;
/// Places of a jump that are tried per round; the next round looks between the neighbours of the best.
const ROUND: usize = 8;

/// The functions 1, u, u^2, hinge and step at a sample.
type Row = SVector<f64, 5>;
/// The channels at a sample, relative to the sample after the knot.
type Values = SVector<f64, 3>;
/// Coefficients of the functions for each channel.
type Coefficients = SMatrix<f64, 5, 3>;

/// Fits of a quadratic with a hinge at the knot, without and with a step there.
struct HingeFit {
    /// Sums of squares of the residuals over the noise variance, without and with the step.
    kinked: [f64; 3],
    stepped: [f64; 3],
    /// Change of slope without step; change of slope and step of the fit with both.
    slope: [f64; 3],
    both: [[f64; 2]; 3],
    /// Norms of hinge and step, each without its part along the functions before it.
    hinge_norm: f64,
    step_norm: f64,
}

impl KnotData<'_> {
    /// The kink of bins `from..to`, at first guess at `guess`, and the residuals' sum of squares over the variance.
    pub fn kink(&self, from: usize, to: usize, guess: f64) -> Option<(FittedTransition, f64)> {
        if to < from + 6 {
            return None;
        }
        let (first, last) = (self.tau[from + 1], self.tau[to - 2]);
        let mut tau = guess.clamp(first, last);
        let mut best: Option<(FittedTransition, f64)> = None;
        for _ in 0..MOVES {
            let next = self.tau[from..to].partition_point(|t| *t <= tau) + from;
            let Some(fit) = self.fit(from, to, tau, next) else { break };
            let total: f64 = fit.kinked.iter().sum();
            if !total.is_finite() {
                return best;
            }
            let weight = |c: usize| self.sigma[c].powi(-2);
            let steep: f64 = (0..3).map(|c| weight(c) * fit.slope[c].powi(2)).sum();
            if best.as_ref().is_none_or(|b| total < b.1) {
                let misfit = (total / (3 * (to - from - 5)) as f64).max(1.0).sqrt();
                let placed = FittedTransition {
                    kind: KinkKind::Kink,
                    tau,
                    sigma_tau: misfit / (steep.sqrt() * fit.step_norm),
                    next,
                    change: fit.slope,
                    sigma: self.sigma.map(|s| misfit * s / fit.hinge_norm),
                };
                best = Some((placed, total));
            }
            // a knot that is off by d leaves a step of -d times the change of slope
            let along: f64 = (0..3).map(|c| weight(c) * fit.both[c][0] * fit.both[c][1]).sum();
            let steep: f64 = (0..3).map(|c| weight(c) * fit.both[c][0].powi(2)).sum();
            let limit = 0.25 * (last - first);
            let moved = (tau - (along / steep).clamp(-limit, limit)).clamp(first, last);
            if !moved.is_finite() || (moved - tau).abs() <= 1e-13 * (last - first) {
                break;
            }
            tau = moved;
        }
        best.filter(|b| b.0.sigma_tau.is_finite())
    }

    /// The jump of bins `from..to` between bins `low` and `high`, and the sum of squares.
    pub fn jump(&self, from: usize, to: usize, (low, high): (usize, usize)) -> Option<(FittedTransition, f64)> {
        let (low, high) = (low.max(from + 2), high.min(to.saturating_sub(2)));
        if low > high || to < from + 6 {
            return None;
        }
        let middle = |next: usize| 0.5 * (self.tau[next - 1] + self.tau[next]);
        let total = |next| self.fit(from, to, middle(next), next).map_or(f64::NAN, |fit| fit.stepped.iter().sum());
        let (mut low, mut high) = (low, high);
        let mut best = (f64::INFINITY, low);
        loop {
            let stride = (high - low).div_ceil(ROUND).max(1);
            for next in (low..=high).step_by(stride) {
                let found = total(next);
                if found < best.0 {
                    best = (found, next);
                }
            }
            if stride == 1 {
                break;
            }
            (low, high) = (best.1.saturating_sub(stride).max(low), (best.1 + stride).min(high));
        }
        if !best.0.is_finite() {
            return None;
        }
        let next = best.1;
        let fit = self.fit(from, to, middle(next), next)?;
        let misfit = (best.0 / (3 * (to - from - 5)) as f64).max(1.0).sqrt();
        let placed = FittedTransition {
            kind: KinkKind::Jump,
            tau: middle(next),
            sigma_tau: (self.tau[next] - self.tau[next - 1]) / 12.0_f64.sqrt(),
            next,
            change: fit.both.map(|b| b[1]),
            sigma: self.sigma.map(|s| misfit * s / fit.step_norm),
        };
        Some((placed, best.0))
    }

    /// The fit over samples `from..to` with the knot at `knot`, `next` being the first sample after it; none where the samples do
    /// not determine it.
    fn fit(&self, from: usize, to: usize, knot: f64, next: usize) -> Option<HingeFit> {
        let scale = (self.tau[to - 1] - knot).max(knot - self.tau[from]);
        let row = |i: usize| {
            let u = (self.tau[i] - knot) / scale;
            Row::from([1.0, u, u * u, if i >= next { u } else { 0.0 }, if i >= next { 1.0 } else { 0.0 }])
        };
        let offset = [0, 1, 2].map(|c| self.channels[c][next.min(to - 1)]);
        let values = |i: usize| Values::from([0, 1, 2].map(|c| self.channels[c][i] - offset[c]));
        // normal equations, so that no rows are stored; the solutions are corrected once, on the residuals
        let mut equations = NormalEquations::<5, 3>::default();
        (from..to).for_each(|i| equations.add(&row(i), &values(i), 1.0));
        let both = equations.factor()?;
        let lower = both.l();
        let hinge = equations.factor_of_first::<4>()?;
        let hinge_only = |right: &Coefficients| hinge.solve(&right.fixed_rows::<4>(0).into_owned()).fixed_resize(0.0);
        let mut stepped: Coefficients = both.solve(&equations.right);
        let mut kinked: Coefficients = hinge_only(&equations.right);
        let (mut of_stepped, mut of_kinked) = (Coefficients::zeros(), Coefficients::zeros());
        for i in from..to {
            let (row, values) = (row(i), values(i));
            of_stepped += row * (values - stepped.tr_mul(&row)).transpose();
            of_kinked += row * (values - kinked.tr_mul(&row)).transpose();
        }
        stepped += both.solve(&of_stepped);
        kinked += hinge_only(&of_kinked);
        let (mut left_stepped, mut left_kinked) = (Values::zeros(), Values::zeros());
        for i in from..to {
            let (row, values) = (row(i), values(i));
            left_stepped += (values - stepped.tr_mul(&row)).map(|v| v * v);
            left_kinked += (values - kinked.tr_mul(&row)).map(|v| v * v);
        }
        let variance = self.sigma.map(|sigma| sigma * sigma);
        Some(HingeFit {
            kinked: [0, 1, 2].map(|c| left_kinked[c] / variance[c]),
            stepped: [0, 1, 2].map(|c| left_stepped[c] / variance[c]),
            slope: [0, 1, 2].map(|c| kinked[(3, c)] / scale),
            both: [0, 1, 2].map(|c| [stepped[(3, c)] / scale, stepped[(4, c)]]),
            hinge_norm: lower[(3, 3)] * scale,
            step_norm: lower[(4, 4)],
        })
    }
}
