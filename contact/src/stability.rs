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
use crate::shape::{Node, Shape};
use crate::world::World;
use nalgebra::{DMatrix, Dim, Matrix, SMatrix, StorageMut};
use rod_core::{Hold, Supports};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Modes beyond those that the contacts fix. Mode m has energy about (m pi)^2 / 2, so that only loads P of hundreds of
/// EI / L^2 could destabilise one that is left out.
const MODES: usize = 6;
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

/// The modes sin((m + 1/2) x), by the recurrence of Chebyshev.
fn modes_at(x: f64, size: usize) -> Modes {
    let (sin, cos) = (0.5 * x).sin_cos();
    let twice_cos = 2.0 * (cos * cos - sin * sin);
    let (mut before, mut here) = (-sin, sin);
    let next = |_| {
        let mode = here;
        (before, here) = (here, twice_cos * here - before);
        mode
    };
    (0..size).map(next).collect()
}

/// Points of the rod that are worked on at once: the recurrences from mode to mode wait for themselves, not for each other.
const LANES: usize = 4;
/// One number a lane.
type Lanes = [f64; LANES];

/// What is integrated along the rod for the modes eta_m = sin((m + 1/2) x), by Simpson's rule, lane by lane.
struct Integrals {
    /// int (-sin phi, cos phi) eta_m ds from the clamp on: how far mode m moves the rod's points.
    shift_x: SmallVec<[Lanes; 24]>,
    shift_y: SmallVec<[Lanes; 24]>,
    /// int -(A sin phi - B cos phi) cos(m x) ds / 2.
    moments: SmallVec<[Lanes; 64]>,
}

impl Integrals {
    fn new(size: usize) -> Self {
        let zeros = || SmallVec::from_elem([0.0; LANES], size);
        Self { shift_x: zeros(), shift_y: zeros(), moments: SmallVec::from_elem([0.0; LANES], 2 * size) }
    }

    /// Goes on along the `nodes` of a span under the force (A, B), with x = `scale` s.
    fn add(&mut self, nodes: &[Node], (a, b): (f64, f64), scale: f64) {
        let [first, .., last] = nodes else { return };
        let intervals = nodes.len() - 1;
        let h = (last.s - first.s) / intervals as f64;
        // sine and cosine of half of x, by turning on
        let (mut sin, mut cos) = (0.5 * scale * first.s).sin_cos();
        let (sin_h, cos_h) = (0.5 * scale * h).sin_cos();
        for (block, nodes) in nodes.chunks(LANES).enumerate() {
            let [mut sines, mut cosines, mut by_x, mut by_y, mut load] = [[0.0; LANES]; 5];
            for (lane, Node { at, .. }) in nodes.iter().enumerate() {
                let k = LANES * block + lane;
                let weight = if k == 0 || k == intervals { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 } * h / 3.0;
                (sines[lane], cosines[lane]) = (sin, cos);
                (by_x[lane], by_y[lane]) = (-weight * at.sin, weight * at.cos);
                load[lane] = -0.5 * weight * (a * at.sin - b * at.cos);
                (sin, cos) = (sin * cos_h + cos * sin_h, cos * cos_h - sin * sin_h);
            }
            let cos_x = lanes(|l| cosines[l] * cosines[l] - sines[l] * sines[l]);
            let recurrence = |here: &Lanes, before: &Lanes| lanes(|l| 2.0 * cos_x[l] * here[l] - before[l]);
            let (mut before, mut here) = (sines.map(|sin| -sin), sines);
            for (x, y) in self.shift_x.iter_mut().zip(&mut self.shift_y) {
                *x = lanes(|l| x[l] + by_x[l] * here[l]);
                *y = lanes(|l| y[l] + by_y[l] * here[l]);
                (before, here) = (here, recurrence(&here, &before));
            }
            let (mut before, mut here) = (lanes(|l| load[l] * cos_x[l]), load);
            for moment in &mut self.moments {
                *moment = lanes(|l| moment[l] + here[l]);
                (before, here) = (here, recurrence(&here, &before));
            }
        }
    }

    /// How far each mode moves the rod where it is now, in the direction `(cos, sin)` and across it.
    fn shifts(&self, cos: f64, sin: f64) -> (Modes, Modes) {
        let shift = |(x, y): (&Lanes, &Lanes)| (x.iter().sum::<f64>(), y.iter().sum::<f64>());
        let shifts = || self.shift_x.iter().zip(&self.shift_y).map(shift);
        (shifts().map(|(x, y)| cos * x + sin * y).collect(), shifts().map(|(x, y)| cos * y - sin * x).collect())
    }
}

fn lanes(f: impl Fn(usize) -> f64) -> Lanes {
    std::array::from_fn(f)
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
pub(crate) fn is_stable(world: &World<'_>, configuration: &Configuration, shape: &Shape) -> bool {
    let n = configuration.count();
    if n == 0 {
        return true;
    }
    let size = MODES + 2 * n;
    let end = configuration.s(n - 1);
    let scale = PI / end;
    let mut q = Quadratic::diagonal((0..size).map(|m| 0.5 * end * ((m as f64 + 0.5) * scale).powi(2)));
    // Positions change by int (-sin phi, cos phi) eta: accumulated from contact to contact.
    let mut integrals = Integrals::new(size);
    let supports = configuration.supports(world);
    for j in 0..n {
        let Span { a, b, .. } = shape.spans[j];
        integrals.add(shape.along(j), (a, b), scale);
        let support = supports.support(j, configuration.t(j));
        let (sin, cos) = support.alpha.sin_cos();
        let (along, across) = integrals.shifts(cos, sin);
        q.add(PENALTY, &across, &across);
        let (v, w, f) = (support.speed, support.turning, configuration.force(j));
        match configuration.contacts[j].hold {
            // held in a notch from both sides; on a convex vertex the tip slips
            Hold::Tip if v == 0.0 && w < 0.0 => q.add(PENALTY, &along, &along),
            Hold::Tip if v == 0.0 => return false,
            Hold::Tip => q.add(-f * w / v, &along, &along),
            Hold::Tangent { offset } => {
                let eta = modes_at(configuration.s(j) * scale, size);
                let kappa = offset.cos() * shape.spans[j + 1].start.kappa;
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
    let moments: SmallVec<[f64; 64]> = integrals.moments.iter().map(|lanes| lanes.iter().sum()).collect();
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
        let mut shape = Shape::default();
        shape.follow(&world, &path, &column);
        is_stable(&world, &column, &shape)
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
