//! The functions that are fitted to a window, and the verdict of the fit.

use crate::numeric::{dot, orthonormalise, subtract};

/// Most bins on either side of a node.
pub(crate) const MOST_BINS: usize = 12;
/// Fewest bins on either side of a node.
pub(crate) const FEWEST_BINS: usize = 3;
/// Most bins in a window.
pub(crate) const ROWS: usize = 2 * MOST_BINS;

/// A function at the bins of a window; zero beyond them.
pub(crate) type Row = [f64; ROWS];

/// Orthonormal functions over a window with a node at 0: a quadratic; a hinge and a step at the node, without their quadratic part;
/// and in their place a cubic and a quartic, without theirs.
#[derive(Clone, Debug)]
pub(crate) struct WindowBasis {
    pub quadratic: [Row; 3],
    pub hinge: Row,
    pub step: Row,
    pub quartic: [Row; 2],
    /// Norms of the hinge and the step without the functions before them, and the component of the step along the hinge.
    hinge_norm: f64,
    step_norm: f64,
    shared: f64,
}

impl WindowBasis {
    /// From the positions of the bins, `left` of them before the node at 0, in widths of a bin.
    pub fn new(positions: &[f64], left: usize) -> Self {
        let mut columns = [[0.0; ROWS]; 7];
        let scale = positions.iter().fold(0.0_f64, |m, p| m.max(p.abs())).max(f64::MIN_POSITIVE);
        for (i, position) in positions.iter().take(ROWS).enumerate() {
            let (u, after) = (position / scale, i >= left);
            let values = [1.0, u, u * u, if after { *position } else { 0.0 }, if after { 1.0 } else { 0.0 }];
            for (column, value) in columns.iter_mut().zip(values) {
                column[i] = value;
            }
            (columns[5][i], columns[6][i]) = (u * u * u, u * u * u * u);
        }
        let [mut one, mut linear, mut square, mut hinge, mut step, mut cubic, mut quartic] = columns;
        orthonormalise::<Row>(&mut one, &[]);
        orthonormalise(&mut linear, &[one]);
        orthonormalise(&mut square, &[one, linear]);
        let hinge_norm = orthonormalise(&mut hinge, &[one, linear, square]);
        let whole = step;
        let step_norm = orthonormalise(&mut step, &[one, linear, square, hinge]);
        orthonormalise(&mut cubic, &[one, linear, square]);
        orthonormalise(&mut quartic, &[one, linear, square, cubic]);
        let shared = dot(&whole, &hinge);
        Self { quadratic: [one, linear, square], hinge, step, quartic: [cubic, quartic], hinge_norm, step_norm, shared }
    }

    /// For evenly spaced bins; `gap` bins at the node itself are left out.
    pub fn even(left: usize, right: usize, gap: usize) -> Self {
        let first = if gap == 0 { 0.5 } else { 0.5 * (1.0 + gap as f64) };
        let mut positions = [0.0; ROWS];
        for i in 0..left {
            positions[left - 1 - i] = -(first + i as f64);
        }
        for i in 0..right {
            positions[left + i] = first + i as f64;
        }
        Self::new(&positions[..left + right], left)
    }

    /// Change of slope per width of a bin, and step at the node, from the components along `hinge` and `step`.
    pub fn changes(&self, along: [f64; 2]) -> [f64; 2] {
        let step = along[1] / self.step_norm;
        [(along[0] - step * self.shared) / self.hinge_norm, step]
    }

    /// Sum of squares that a change of slope (per width of a bin) and a step explain.
    pub fn power(&self, changes: [f64; 2]) -> f64 {
        (changes[0] * self.hinge_norm + changes[1] * self.shared).powi(2) + (changes[1] * self.step_norm).powi(2)
    }
}

/// The channels over a window, and how the models fit them.
pub(crate) struct BinWindow<'a> {
    pub basis: &'a WindowBasis,
    pub bins: usize,
    pub y: [Row; 3],
}

/// How well a transition at the node explains a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Verdict {
    /// Sum over channels of squares of hinge, and of hinge and step, over the variance (of the noise, or the misfit
    /// where that is larger).
    pub hinge: f64,
    pub both: f64,
    /// Sum of squares of the residuals of a quartic, less that of quadratic, hinge and step.
    pub margin: f64,
    /// Largest ratio of misfit to noise, 1 where noise explains the residuals.
    pub misfit: f64,
    /// Changes of slope (per width of a bin) and steps.
    pub changes: [[f64; 2]; 3],
}

/// Share of the sum of squares below which a difference of squares is computed from the residuals instead, because it cancels.
const CANCELLED: f64 = 1e-6;

impl BinWindow<'_> {
    /// Squares of hinge and of both over the noise variances: upper bounds of the verdict's.
    pub fn glance(&self, variance: &[f64; 3]) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        for (y, variance) in self.y.iter().zip(variance) {
            let (hinge, step) = (dot(y, &self.basis.hinge), dot(y, &self.basis.step));
            sums.0 += hinge * hinge / variance;
            sums.1 += (hinge * hinge + step * step) / variance;
        }
        sums
    }

    /// The verdict; `usual` is the 95 % quantile of the residuals' sum of squares over the variance.
    pub fn judge(&self, variance: &[f64; 3], usual: f64) -> Verdict {
        let mut verdict = Verdict { hinge: 0.0, both: 0.0, margin: 0.0, misfit: 1.0, changes: [[0.0; 2]; 3] };
        for (channel, (y, variance)) in self.y.iter().zip(variance).enumerate() {
            let mut rest = *y;
            for column in &self.basis.quadratic {
                let share = dot(&rest, column);
                subtract(&mut rest, share, column);
            }
            let along = [dot(&rest, &self.basis.hinge), dot(&rest, &self.basis.step)];
            let bent = self.basis.quartic.each_ref().map(|column| dot(&rest, column));
            let whole = dot(&rest, &rest);
            let smooth = whole - bent[0] * bent[0] - bent[1] * bent[1];
            let mut kinked = whole - along[0] * along[0] - along[1] * along[1];
            if kinked < CANCELLED * whole {
                subtract(&mut rest, along[0], &self.basis.hinge);
                subtract(&mut rest, along[1], &self.basis.step);
                kinked = dot(&rest, &rest);
            }
            let misfit = (kinked / (usual * variance)).max(1.0);
            let variance = variance * misfit;
            verdict.hinge += along[0] * along[0] / variance;
            verdict.both += (along[0] * along[0] + along[1] * along[1]) / variance;
            verdict.margin += (smooth - kinked) / variance;
            verdict.misfit = verdict.misfit.max(misfit);
            verdict.changes[channel] = self.basis.changes(along);
        }
        verdict
    }
}
