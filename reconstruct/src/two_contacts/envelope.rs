//! The first of several contacts, from the envelope of the rod's shapes along a scan.
//!
//! The reactions determine the rod up to its first contact, however many follow. Along the scan these shapes are a family of
//! curves. A frictionless contact moves along its own tangent, so that the normal speed of the family vanishes there:
//! v_n(s) = n(s) . dr(s; tau) / dtau = 0.

use crate::point::Inverse;
use crate::scan::LocalEstimate;
use nalgebra::{Matrix2x3, Vector2, Vector3, Vector4};
use rod_core::Section;

/// Places along the rod between which the normal speed is searched for changes of sign. Two roots between neighbours are missed.
const PLACES: usize = 48;
/// Most iterations of the safeguarded Newton's method; bisection alone would need 50.
const STEPS: usize = 60;

/// The normal speed of the rod at arc length s, and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct NormalSpeed {
    pub section: Section,
    /// v_n, and its derivative by s.
    pub value: f64,
    pub by_s: f64,
    /// Derivatives by the rates of the reactions.
    pub by_rate: Vector3<f64>,
}

impl NormalSpeed {
    pub fn at<I: Inverse>(rod: &I, estimate: &LocalEstimate, s: f64) -> Self {
        let (section, gradient) = rod.gradient_at(&estimate.clamp, s);
        let rate: Vector4<f64> = gradient.rate(&estimate.rate);
        let (sin, cos) = section.phi.sin_cos();
        let (normal, tangent) = (Vector2::new(-sin, cos), Vector2::new(cos, sin));
        let velocity = Vector2::new(rate[0], rate[1]);
        let place_by_reactions: Matrix2x3<f64> = gradient.by_reactions.fixed_rows::<2>(0).into_owned();
        Self {
            section,
            value: normal.dot(&velocity),
            by_s: rate[2] - section.kappa * tangent.dot(&velocity),
            by_rate: place_by_reactions.tr_mul(&normal),
        }
    }
}

/// All places before arc length `end` where the rod touches the envelope, from the clamp outwards.
pub(super) fn touches<I: Inverse>(
    rod: &I,
    estimate: &LocalEstimate,
    end: f64,
    mut found: impl FnMut(f64, NormalSpeed),
) {
    let mut before = (0.0, NormalSpeed::at(rod, estimate, 0.0));
    for place in 1..=PLACES {
        let s = end * place as f64 / PLACES as f64;
        let here = (s, NormalSpeed::at(rod, estimate, s));
        if before.1.value * here.1.value < 0.0 {
            let (s, speed) = root(rod, estimate, before, here);
            found(s, speed);
        }
        before = here;
    }
}

/// The zero of the normal speed between two places where its signs differ.
fn root<I: Inverse>(
    rod: &I,
    estimate: &LocalEstimate,
    from: (f64, NormalSpeed),
    to: (f64, NormalSpeed),
) -> (f64, NormalSpeed) {
    let (mut low, mut high) = (from, to);
    let mut best = if low.1.value.abs() < high.1.value.abs() { low } else { high };
    for _ in 0..STEPS {
        let newton = best.0 - best.1.value / best.1.by_s;
        let inside = newton > low.0 && newton < high.0;
        let s = if inside { newton } else { 0.5 * (low.0 + high.0) };
        let here = (s, NormalSpeed::at(rod, estimate, s));
        let settled = (s - best.0).abs() <= 4.0 * f64::EPSILON;
        best = here;
        if settled || here.1.value == 0.0 {
            break;
        }
        if here.1.value * low.1.value > 0.0 {
            low = here;
        } else {
            high = here;
        }
    }
    best
}
