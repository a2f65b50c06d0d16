//! Where a transition is, and how large: least squares with a free knot, on samples or on bins of them.

use super::KinkKind;

/// A transition placed between samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
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
pub(crate) struct Part<'a> {
    pub tau: &'a [f64],
    pub channels: [&'a [f64]; 3],
    pub sigma: [f64; 3],
}

/// Moves of the knot at most.
const MOVES: usize = 12;
/// Steps of the search for the place of a jump, per round.
const ROUND: usize = 8;

/// Fit of a quadratic with a hinge at the knot, and of what a step there would add.
struct Fit {
    /// Residuals' sums of squares over the noise variance, without and with the step.
    kinked: [f64; 3],
    stepped: [f64; 3],
    /// Change of slope without step, and slope and step of the fit with both.
    slope: [f64; 3],
    both: [[f64; 2]; 3],
    /// Norms of hinge and step, each without what the functions before it explain.
    hinge_norm: f64,
    step_norm: f64,
}

impl Part<'_> {
    /// The kink of bins `from..to`, at first guess at `guess`, and the residuals' sum of squares over the variance.
    pub fn kink(&self, from: usize, to: usize, guess: f64) -> Option<(Placed, f64)> {
        if to < from + 6 {
            return None;
        }
        let (first, last) = (self.tau[from + 1], self.tau[to - 2]);
        let mut tau = guess.clamp(first, last);
        let mut best: Option<(Placed, f64)> = None;
        for _ in 0..MOVES {
            let fit = self.fit(from, to, tau, self.tau[from..to].partition_point(|t| *t <= tau) + from);
            let total: f64 = fit.kinked.iter().sum();
            if !total.is_finite() {
                return best;
            }
            let weight = |c: usize| self.sigma[c].powi(-2);
            let steep: f64 = (0..3).map(|c| weight(c) * fit.slope[c].powi(2)).sum();
            if best.as_ref().is_none_or(|b| total < b.1) {
                let misfit = (total / (3 * (to - from - 5)) as f64).max(1.0).sqrt();
                let placed = Placed {
                    kind: KinkKind::Kink,
                    tau,
                    sigma_tau: misfit / (steep.sqrt() * fit.step_norm),
                    next: self.tau[from..to].partition_point(|t| *t <= tau) + from,
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
    pub fn jump(&self, from: usize, to: usize, (low, high): (usize, usize)) -> Option<(Placed, f64)> {
        let (low, high) = (low.max(from + 2), high.min(to.saturating_sub(2)));
        if low > high || to < from + 6 {
            return None;
        }
        let middle = |next: usize| 0.5 * (self.tau[next - 1] + self.tau[next]);
        let total = |next: usize| self.fit(from, to, middle(next), next).stepped.iter().sum::<f64>();
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
        let fit = self.fit(from, to, middle(next), next);
        let misfit = (best.0 / (3 * (to - from - 5)) as f64).max(1.0).sqrt();
        let placed = Placed {
            kind: KinkKind::Jump,
            tau: middle(next),
            sigma_tau: (self.tau[next] - self.tau[next - 1]) / 12.0_f64.sqrt(),
            next,
            change: fit.both.map(|b| b[1]),
            sigma: self.sigma.map(|s| misfit * s / fit.step_norm),
        };
        Some((placed, best.0))
    }

    /// The fit over samples `from..to` with the knot at `knot`, `next` being the first sample after it.
    fn fit(&self, from: usize, to: usize, knot: f64, next: usize) -> Fit {
        let scale = (self.tau[to - 1] - knot).max(knot - self.tau[from]);
        let row = |i: usize| {
            let u = (self.tau[i] - knot) / scale;
            [1.0, u, u * u, if i >= next { u } else { 0.0 }, if i >= next { 1.0 } else { 0.0 }]
        };
        // normal equations, so that no columns are stored; the residuals below make up for their condition
        let mut normal = [[0.0; 5]; 5];
        let mut moments = [[0.0; 5]; 3];
        let offset = [0, 1, 2].map(|c| self.channels[c][next.min(to - 1)]);
        for i in from..to {
            let row = row(i);
            for a in 0..5 {
                for b in 0..=a {
                    normal[a][b] += row[a] * row[b];
                }
            }
            for (c, moment) in moments.iter_mut().enumerate() {
                let y = self.channels[c][i] - offset[c];
                moment.iter_mut().zip(row).for_each(|(m, r)| *m += r * y);
            }
        }
        let lower = cholesky(normal);
        let mut fit = Fit {
            kinked: [0.0; 3],
            stepped: [0.0; 3],
            slope: [0.0; 3],
            both: [[0.0; 2]; 3],
            hinge_norm: lower[3][3] * scale,
            step_norm: lower[4][4],
        };
        let mut coefficients = [[0.0; 5]; 3];
        let mut bent = [[0.0; 5]; 3];
        for c in 0..3 {
            // once more on the residuals: the normal equations square the condition
            for round in 0..2 {
                let rest =
                    if round == 0 { moments[c] } else { self.left(from, to, &row, c, offset[c], &coefficients[c]) };
                add(&mut coefficients[c], solve(&lower, rest, 5));
                let rest = if round == 0 { moments[c] } else { self.left(from, to, &row, c, offset[c], &bent[c]) };
                add(&mut bent[c], solve(&lower, rest, 4));
            }
            let variance = self.sigma[c] * self.sigma[c];
            for i in from..to {
                let (row, y) = (row(i), self.channels[c][i] - offset[c]);
                let value = |k: &[f64; 5]| row.iter().zip(k).map(|(r, k)| r * k).sum::<f64>();
                fit.stepped[c] += (y - value(&coefficients[c])).powi(2) / variance;
                fit.kinked[c] += (y - value(&bent[c])).powi(2) / variance;
            }
            fit.slope[c] = bent[c][3] / scale;
            fit.both[c] = [coefficients[c][3] / scale, coefficients[c][4]];
        }
        fit
    }

    /// Moments of the residuals.
    fn left(
        &self,
        from: usize,
        to: usize,
        row: &impl Fn(usize) -> [f64; 5],
        c: usize,
        offset: f64,
        coefficients: &[f64; 5],
    ) -> [f64; 5] {
        let mut moments = [0.0; 5];
        for i in from..to {
            let row = row(i);
            let value: f64 = row.iter().zip(coefficients).map(|(r, k)| r * k).sum();
            let rest = self.channels[c][i] - offset - value;
            moments.iter_mut().zip(row).for_each(|(m, r)| *m += r * rest);
        }
        moments
    }
}

fn add(a: &mut [f64; 5], b: [f64; 5]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
}

/// Lower triangular factor.
fn cholesky(mut a: [[f64; 5]; 5]) -> [[f64; 5]; 5] {
    for j in 0..5 {
        for k in 0..j {
            a[j][j] -= a[j][k] * a[j][k];
        }
        a[j][j] = a[j][j].max(0.0).sqrt();
        for i in j + 1..5 {
            for k in 0..j {
                a[i][j] -= a[i][k] * a[j][k];
            }
            a[i][j] /= a[j][j];
        }
    }
    a
}

/// Solution of the first `size` normal equations; 0 for the others.
fn solve(lower: &[[f64; 5]; 5], mut rest: [f64; 5], size: usize) -> [f64; 5] {
    for i in 0..size {
        for k in 0..i {
            rest[i] -= lower[i][k] * rest[k];
        }
        rest[i] /= lower[i][i];
    }
    for i in (0..size).rev() {
        for k in i + 1..size {
            rest[i] -= lower[k][i] * rest[k];
        }
        rest[i] /= lower[i][i];
    }
    rest[size..].fill(0.0);
    rest
}
