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
//! d alpha/dt = w). The equilibrium is stable if Q > 0 for all such eta. eta is expanded in the first modes of a free
//! cantilever, the constraints enter by a large penalty, and Q is positive exactly if its matrix has a Cholesky factor.

use crate::configuration::Configuration;
use crate::path::ClampPath;
use crate::world::World;
use nalgebra::DMatrix;
use rod_core::{Hold, Section, Supports, walk};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Modes beyond those that the contacts fix. Mode m has energy about (m pi)^2 / 2, so that only loads P of hundreds of
/// EI / L^2 could destabilise one that is left out.
const MODES: usize = 10;
/// Quadrature points a unit of length: several a wave of the highest mode, by Simpson's rule.
const POINTS: f64 = 48.0;
/// Stiffness of the penalty against that of the modes.
const PENALTY: f64 = 1e9;

/// Whether the second variation is positive definite.
pub(crate) fn is_stable(world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> bool {
    if configuration.count() == 0 {
        return true;
    }
    let n = configuration.count();
    let modes = MODES + 2 * n;
    let end = configuration.s(n - 1);
    let wave = |m: usize| (m as f64 + 0.5) * PI / end;
    let mode = |s: f64| -> SmallVec<[f64; 32]> { (0..modes).map(|m| (wave(m) * s).sin()).collect() };

    let mut q = DMatrix::from_fn(modes, modes, |i, j| if i == j { 0.5 * end * wave(i).powi(2) } else { 0.0 });
    let mut spans: SmallVec<[(f64, Section, f64, f64); 9]> = SmallVec::new();
    configuration.segments(world, path, |s, start, a, b| spans.push((s, start, a, b)));

    // Positions change by int (-sin phi, cos phi) eta: accumulated from contact to contact.
    let mut shift_x: SmallVec<[f64; 32]> = SmallVec::from_elem(0.0, modes);
    let mut shift_y = shift_x.clone();
    let mut rank_one: Vec<(f64, SmallVec<[f64; 32]>)> = Vec::new();
    let supports = configuration.supports(world);
    for j in 0..n {
        let (from, start, a, b) = spans[j];
        let length = configuration.s(j) - from;
        if length > 0.0 {
            let steps = 2 * ((length * POINTS / 2.0).ceil() as usize).max(2);
            let h = length / steps as f64;
            let sections = std::iter::once(start).chain(walk(&start, a, b, length, steps));
            for (k, at) in sections.enumerate() {
                let simpson = if k == 0 || k == steps { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 } * h / 3.0;
                let eta = mode(from + h * k as f64);
                let (sin, cos) = at.phi.sin_cos();
                let load = simpson * (a * sin - b * cos);
                for i in 0..modes {
                    shift_x[i] -= simpson * sin * eta[i];
                    shift_y[i] += simpson * cos * eta[i];
                    for l in 0..=i {
                        q[(i, l)] -= load * eta[i] * eta[l];
                    }
                }
            }
        }
        let support = supports.support(j, configuration.t(j));
        let (sin, cos) = support.alpha.sin_cos();
        let along: SmallVec<[f64; 32]> = (0..modes).map(|i| cos * shift_x[i] + sin * shift_y[i]).collect();
        let across = (0..modes).map(|i| cos * shift_y[i] - sin * shift_x[i]).collect();
        rank_one.push((PENALTY, across));
        let (v, w, f) = (support.speed, support.turning, configuration.force(j));
        match configuration.contacts[j].hold {
            // held in a notch from both sides; on a convex vertex the tip slips
            Hold::Tip if v == 0.0 && w < 0.0 => rank_one.push((PENALTY, along)),
            Hold::Tip if v == 0.0 => return false,
            Hold::Tip => rank_one.push((-f * w / v, along)),
            Hold::Tangent { offset } => {
                let eta = mode(configuration.s(j));
                let kappa = offset.cos() * spans[j + 1].1.kappa;
                let divisor = w - v * kappa;
                if divisor <= 0.0 {
                    return false;
                }
                let scale = f / divisor;
                for i in 0..modes {
                    for l in 0..=i {
                        let cross = w * (eta[i] * along[l] + eta[l] * along[i]);
                        let g = cross - w * kappa * along[i] * along[l] - v * eta[i] * eta[l];
                        q[(i, l)] -= scale * g;
                    }
                }
            }
        }
    }
    for (weight, vector) in rank_one {
        for i in 0..modes {
            for l in 0..=i {
                q[(i, l)] += weight * vector[i] * vector[l];
            }
        }
    }
    // Cholesky reads the lower triangle alone
    q.cholesky().is_some()
}
