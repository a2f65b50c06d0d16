//! The functions that a window is fitted with.

/// Most bins on either side of a node.
pub(crate) const MOST: usize = 12;
/// Fewest bins on either side of a node.
pub(crate) const FEWEST: usize = 3;
/// Most bins in a window.
pub(crate) const ROWS: usize = 2 * MOST;

/// A function at the bins of a window; zero beyond them.
pub(crate) type Row = [f64; ROWS];

pub(crate) fn dot(a: &Row, b: &Row) -> f64 {
    // four sums at once, so that the processor's lanes are used
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

fn subtract(a: &mut Row, share: f64, b: &Row) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= share * b);
}

/// Orthonormal functions over a window with a node at 0: a quadratic, what a hinge and a step at the node add to it,
/// and what a cubic and a quartic add to it in their place.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    pub quadratic: [Row; 3],
    pub hinge: Row,
    pub step: Row,
    pub quartic: [Row; 2],
    /// Norms of what hinge and step add, and the share of the step that the hinge takes.
    hinge_norm: f64,
    step_norm: f64,
    shared: f64,
}

impl Basis {
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
        normalised(&mut one, &[]);
        normalised(&mut linear, &[&one]);
        normalised(&mut square, &[&one, &linear]);
        let hinge_norm = normalised(&mut hinge, &[&one, &linear, &square]);
        let whole = step;
        let step_norm = normalised(&mut step, &[&one, &linear, &square, &hinge]);
        normalised(&mut cubic, &[&one, &linear, &square]);
        normalised(&mut quartic, &[&one, &linear, &square, &cubic]);
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

    /// What a change of slope (per width of a bin) and a step add to the sum of squares.
    pub fn power(&self, changes: [f64; 2]) -> f64 {
        (changes[0] * self.hinge_norm + changes[1] * self.shared).powi(2) + (changes[1] * self.step_norm).powi(2)
    }
}

/// Makes `column` normal to the others and of length 1; its length before.
fn normalised(column: &mut Row, others: &[&Row]) -> f64 {
    // twice is enough (Giraud et al. 2005)
    for _ in 0..2 {
        for other in others {
            let share = dot(column, other);
            subtract(column, share, other);
        }
    }
    let norm = dot(column, column).sqrt();
    if norm > 0.0 {
        column.iter_mut().for_each(|c| *c /= norm);
    }
    norm
}

/// The channels over a window, and how the models fit them.
pub(crate) struct Window<'a> {
    pub basis: &'a Basis,
    pub bins: usize,
    pub y: [Row; 3],
}

/// How a window speaks for a transition at its node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Verdict {
    /// Sum over channels of squares of hinge, and of hinge and step, over the variance (of the noise, or the misfit
    /// where that is larger).
    pub hinge: f64,
    pub both: f64,
    /// By how much the residuals of a quartic are larger than those of quadratic, hinge and step.
    pub margin: f64,
    /// Largest ratio of misfit to noise, 1 where noise explains the residuals.
    pub misfit: f64,
    /// Changes of slope (per width of a bin) and steps.
    pub changes: [[f64; 2]; 3],
}

/// A difference of squares that is a smaller share of them is computed from residuals instead.
const CANCELLED: f64 = 1e-6;

impl Window<'_> {
    /// Squares of hinge and of both over the noise variances alone: at least as large as the verdict's.
    pub fn glance(&self, variance: &[f64; 3]) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        for (y, variance) in self.y.iter().zip(variance) {
            let (hinge, step) = (dot(y, &self.basis.hinge), dot(y, &self.basis.step));
            sums.0 += hinge * hinge / variance;
            sums.1 += (hinge * hinge + step * step) / variance;
        }
        sums
    }

    /// The verdict; `usual` is what the residuals' sum of squares over the variance is below in 95 of 100 windows.
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
