//! A contact point as the assembly needs it.

use crate::point::Touch;
use nalgebra::{Matrix2, Vector2};

/// One contact of one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPoint {
    pub sample: usize,
    pub at: Vector2<f64>,
    /// Tangent of the contour times the contact force, N. Its error is that of the reactions, the same in every sample; the error of
    /// the angle grows without bound as the force vanishes.
    pub force: Vector2<f64>,
    /// Tangent of the contour, a unit vector.
    pub tangent: Vector2<f64>,
    /// Arc length along the rod, infinite where it is not known.
    pub s: f64,
    /// Covariance of the position, as if it shared its noise with no other sample; zero where it is not known.
    pub covariance: Matrix2<f64>,
    /// Number of samples that share the noise.
    pub shared: f64,
}

impl ContactPoint {
    /// None where position or angle are not finite.
    pub fn of(sample: usize, touch: &Touch, shared: usize) -> Option<Self> {
        let shared = shared.max(1) as f64;
        if ![touch.x, touch.y, touch.alpha].into_iter().all(f64::is_finite) {
            return None;
        }
        let force = if touch.force.is_finite() { touch.force.max(0.0) } else { 0.0 };
        let (sin, cos) = touch.alpha.sin_cos();
        // what all samples share does not average out, and does not depend on how the points are assembled
        let c = touch.covariance - touch.systematic;
        let known = c.iter().all(|entry| entry.is_finite()) && c[(0, 0)] >= 0.0 && c[(1, 1)] >= 0.0;
        let covariance = if known { 0.5 * shared * (c + c.transpose()) } else { Matrix2::zeros() };
        let tangent = Vector2::new(cos, sin);
        let s = if touch.s.is_finite() && touch.s > 0.0 { touch.s } else { f64::INFINITY };
        Some(Self {
            sample,
            at: Vector2::new(touch.x, touch.y),
            force: force * tangent,
            tangent,
            s,
            covariance,
            shared,
        })
    }
}
