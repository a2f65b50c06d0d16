//! Whether an equilibrium is stable: the second variation of the bending energy under the contacts.
//!
//! For a variation eta of the slope angle (eta(0) = 0) that keeps every contact closed to first order,
//!
//! ```text
//! Q = int_0^1 eta'^2 - (A sin phi - B cos phi) eta^2 ds  -  sum_j f_j g_j
//! ```
//!
//! where (A, B) is the force on the segment and g_j the second-order change of gap j: k u^2 at the tip, and
//! (2 w eta u - w kappa' u^2 - v eta^2) / (w - v kappa') where the rod is tangential, with u the shift of the rod's point
//! along the contour, kappa' the rod's curvature in the contour's sense, k = w / v the contour's curvature (dr/dt = v,
//! d alpha/dt = w). Where the straight end of the rod lies on a straight edge (w = kappa' = 0) g_j is of the order
//! -|eta|^(3/2), so that eta is held. The equilibrium is stable if Q > 0 for all such eta. eta is expanded in the first
//! modes of a free cantilever, the constraints enter by a large penalty, and Q is positive exactly if its matrix has a
//! Cholesky factor.

use crate::configuration::{Configuration, Span};
use crate::path::ClampPath;
use crate::world::World;
use nalgebra::{DMatrix, Dim, Matrix, SMatrix, StorageMut};
use rod_core::{Hold, Supports, walk};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Modes beyond those that the contacts fix. Mode m has energy about (m pi)^2 / 2, so that only loads P of hundreds of
/// EI / L^2 could destabilise one that is left out.
const MODES: usize = 6;
/// Quadrature intervals a unit of length: several a wave of the highest mode, by Simpson's rule.
const INTERVALS: f64 = 28.0;
/// Stiffness of the penalty against that of the modes.
const PENALTY: f64 = 1e9;

/// One number a mode.
type Modes = SmallVec<[f64; 24]>;

/// A symmetric matrix, of which the lower triangle is kept, row by row.
struct Quadratic {
    size: usize,
    lower: SmallVec<[f64; 256]>,
}

impl Quadratic {
    fn diagonal(diagonal: impl ExactSizeIterator<Item = f64>) -> Self {
        let size = diagonal.len();
        let mut lower = SmallVec::from_elem(0.0, size * (size + 1) / 2);
        for (i, d) in diagonal.enumerate() {
            lower[i * (i + 3) / 2] = d;
        }
        Self { size, lower }
    }

    /// Adds weight (u v' + v u') / 2.
    fn add(&mut self, weight: f64, u: &[f64], v: &[f64]) {
        let mut entries = self.lower.iter_mut();
        for i in 0..self.size {
            let (ui, vi) = (0.5 * weight * u[i], 0.5 * weight * v[i]);
            for ((entry, u), v) in entries.by_ref().take(i + 1).zip(u).zip(v) {
                *entry += ui * v + vi * u;
            }
        }
    }

    /// Adds the load on the modes by its cosine moments: sin((m + 1/2) x) sin((n + 1/2) x) is half of
    /// cos((m - n) x) - cos((m + n + 1) x).
    fn add_load(&mut self, moments: &[f64]) {
        let mut entries = self.lower.iter_mut();
        for i in 0..self.size {
            for (j, entry) in entries.by_ref().take(i + 1).enumerate() {
                *entry += moments[i - j] - moments[i + j + 1];
            }
        }
    }

    /// Whether there is a Cholesky factor. The usual sizes take no memory.
    fn is_positive(&self) -> bool {
        match self.size {
            8 => self.fill(SMatrix::<f64, 8, 8>::zeros()).cholesky().is_some(),
            10 => self.fill(SMatrix::<f64, 10, 10>::zeros()).cholesky().is_some(),
            12 => self.fill(SMatrix::<f64, 12, 12>::zeros()).cholesky().is_some(),
            size => self.fill(DMatrix::zeros(size, size)).cholesky().is_some(),
        }
    }

    /// The lower triangle, which is all that is read, in a matrix.
    fn fill<D: Dim, S: StorageMut<f64, D, D>>(&self, mut matrix: Matrix<f64, D, D, S>) -> Matrix<f64, D, D, S> {
        let mut entries = self.lower.iter();
        for i in 0..self.size {
            for (j, entry) in entries.by_ref().take(i + 1).enumerate() {
                matrix[(i, j)] = *entry;
            }
        }
        matrix
    }
}

/// The modes sin((m + 1/2) x), by the recurrence of Chebyshev. Returns cos x.
fn modes_at(x: f64, modes: &mut [f64]) -> f64 {
    let (sin, cos) = (0.5 * x).sin_cos();
    let cos_x = cos * cos - sin * sin;
    let (mut before, mut here) = (-sin, sin);
    for mode in modes {
        *mode = here;
        (before, here) = (here, 2.0 * cos_x * here - before);
    }
    cos_x
}

/// Adds weight cos(m x) to moment m, from cos x.
fn add_cosines(cos: f64, weight: f64, moments: &mut [f64]) {
    let (mut before, mut here) = (weight * cos, weight);
    for moment in moments {
        *moment += here;
        (before, here) = (here, 2.0 * cos * here - before);
    }
}

/// The contact where the rod is as curved, towards the solid, as the contour that it lies on: it then touches along a line.
pub(crate) fn wraps(world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Option<usize> {
    let supports = configuration.supports(world);
    let spans = configuration.spans(world, path);
    configuration.contacts.iter().zip(&spans[1..]).enumerate().position(|(j, (contact, span))| match contact.hold {
        Hold::Tangent { offset } => {
            let support = supports.support(j, configuration.t(j));
            let kappa = offset.cos() * span.start.kappa;
            let last = j + 1 == configuration.count();
            support.turning <= support.speed * kappa && !lies_flat(support.turning, kappa, last)
        }
        Hold::Tip => false,
    })
}

/// Whether the end of the rod, straight beyond its last contact, lies on a straight edge.
fn lies_flat(turning: f64, kappa: f64, last: bool) -> bool {
    last && turning == 0.0 && kappa == 0.0
}

/// Whether the second variation is positive definite.
pub(crate) fn is_stable(world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> bool {
    let n = configuration.count();
    if n == 0 {
        return true;
    }
    let size = MODES + 2 * n;
    let end = configuration.s(n - 1);
    let scale = PI / end;
    let mut q = Quadratic::diagonal((0..size).map(|m| 0.5 * end * ((m as f64 + 0.5) * scale).powi(2)));
    let spans = configuration.spans(world, path);

    let zero = Modes::from_elem(0.0, size);
    // Positions change by int (-sin phi, cos phi) eta: accumulated from contact to contact.
    let (mut shift_x, mut shift_y, mut eta) = (zero.clone(), zero.clone(), zero.clone());
    let mut moments: SmallVec<[f64; 64]> = SmallVec::from_elem(0.0, 2 * size);
    let supports = configuration.supports(world);
    for j in 0..n {
        let Span { s: from, start, a, b } = spans[j];
        let length = configuration.s(j) - from;
        if length > 0.0 {
            let steps = 2 * ((length * INTERVALS / 2.0).ceil() as usize).max(2);
            let h = length / steps as f64;
            let sections = std::iter::once(start).chain(walk(&start, a, b, length, steps));
            for (k, at) in sections.enumerate() {
                let simpson = if k == 0 || k == steps { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 } * h / 3.0;
                let cos_x = modes_at((from + h * k as f64) * scale, &mut eta);
                let (sin, cos) = at.phi.sin_cos();
                for ((x, y), eta) in shift_x.iter_mut().zip(&mut shift_y).zip(&eta) {
                    *x -= simpson * sin * eta;
                    *y += simpson * cos * eta;
                }
                add_cosines(cos_x, -0.5 * simpson * (a * sin - b * cos), &mut moments);
            }
        }
        let support = supports.support(j, configuration.t(j));
        let (sin, cos) = support.alpha.sin_cos();
        let along: Modes = shift_x.iter().zip(&shift_y).map(|(x, y)| cos * x + sin * y).collect();
        let across: Modes = shift_x.iter().zip(&shift_y).map(|(x, y)| cos * y - sin * x).collect();
        q.add(PENALTY, &across, &across);
        let (v, w, f) = (support.speed, support.turning, configuration.force(j));
        match configuration.contacts[j].hold {
            // held in a notch from both sides; on a convex vertex the tip slips
            Hold::Tip if v == 0.0 && w < 0.0 => q.add(PENALTY, &along, &along),
            Hold::Tip if v == 0.0 => return false,
            Hold::Tip => q.add(-f * w / v, &along, &along),
            Hold::Tangent { offset } => {
                modes_at(configuration.s(j) * scale, &mut eta);
                let kappa = offset.cos() * spans[j + 1].start.kappa;
                let divisor = w - v * kappa;
                // in a notch the tip may be behind it, at the same place
                if lies_flat(w, kappa, j + 1 == n || configuration.s(j) == 1.0) {
                    q.add(PENALTY, &eta, &eta);
                    continue;
                }
                if divisor <= 0.0 {
                    return false;
                }
                let scale = f / divisor;
                q.add(-2.0 * scale * w, &eta, &along);
                q.add(scale * w * kappa, &along, &along);
                q.add((scale * v).min(PENALTY), &eta, &eta);
            }
        }
    }
    q.add_load(&moments);
    q.is_positive()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::Held;
    use rod_contours::{Composite, Parabola};
    use rod_core::Pose;

    /// A straight rod standing under a ceiling y = 1 + c x^2, pressed with force f: the tip slides, the clamp holds.
    fn stands(c: f64, f: f64) -> bool {
        let contour = Composite::single(Parabola::new([0.0, 1.0], c).unwrap());
        let world = World::new(contour.as_ref(), 1.0);
        let path = ClampPath::standing(Pose { x: 0.0, y: 0.0, phi: 0.5 * PI });
        let mut column = Configuration::free(0.0);
        column.insert(0, Held { stretch: 0, hold: Hold::Tip }, [0.0, f, 0.5 * PI]);
        is_stable(&world, &path, &column)
    }

    #[test]
    fn a_column_buckles_at_eulers_load() {
        let euler = PI * PI / 4.0;
        assert!(stands(0.0, 0.999 * euler));
        assert!(!stands(0.0, 1.001 * euler));
    }

    #[test]
    fn a_ceiling_that_gives_way_buckles_it_earlier_and_a_hollow_one_later() {
        // On a ceiling of curvature k: eta'' + p^2 eta = -k p^2 int eta with p^2 = f, eta(0) = eta'(1) = 0, which has a
        // solution first where (1 + k) cos p = k sin p / p.
        let critical = |k: f64| {
            let (mut low, mut high): (f64, f64) = (1e-3, PI);
            for _ in 0..100 {
                let p = 0.5 * (low + high);
                if (1.0 + k) * p.cos() > k * p.sin() / p { low = p } else { high = p }
            }
            low * low
        };
        for k in [-0.5, 0.5] {
            let f = critical(k);
            assert!(if k > 0.0 { f < PI * PI / 4.0 } else { f > PI * PI / 4.0 });
            assert!(stands(0.5 * k, 0.995 * f) && !stands(0.5 * k, 1.005 * f), "{k}: {f}");
        }
    }
}
