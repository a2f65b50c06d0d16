//! A sample as contours are assembled from it, and a contact point of it.

use crate::phase::Label;
use crate::point::Touch;
use nalgebra::{Matrix2, Vector2};

/// One sample of a scan as contours are assembled from it: its contact phase and its contact points.
///
/// A sample with several contacts has its first contact, or the first and the second; a sample with one contact has that one; a
/// sample without contact points has the reason, if there is one.
///
/// ```
/// use rod_reconstruct::{Label, Measured};
/// let lost = Measured { reason: Some("the rod is shorter than that"), ..Measured::new(Label::B, &[]) };
/// assert!(lost.touches.is_empty());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// The contact phase.
    pub label: Label,
    /// The contact points, from the clamp on.
    pub touches: &'a [Touch],
    /// Why there is no contact point, where there is none.
    pub reason: Option<&'a str>,
    /// Number of neighbouring samples that share the noise of the points: 1 where each has its own, the length of the window where
    /// the points come from fits through many samples.
    pub shared: usize,
}

impl<'a> Measured<'a> {
    /// A sample with its contacts.
    pub fn new(label: Label, touches: &'a [Touch]) -> Self {
        Self { label, touches, reason: None, shared: 1 }
    }

    /// The sample as points of the contour.
    pub(super) fn contour_points(&self, sample: usize) -> SamplePoints {
        let point =
            |index: usize| self.touches.get(index).and_then(|touch| ContactPoint::of(sample, touch, self.shared));
        match self.label {
            Label::Free => SamplePoints::Free,
            label if label.several() => SamplePoints::Several(point(0), point(1)),
            _ => match point(0) {
                Some(point) => SamplePoints::Single(point),
                None if self.touches.is_empty() => {
                    SamplePoints::Nothing(self.reason.unwrap_or("no contact point").to_owned())
                }
                None => SamplePoints::Nothing("the contact point is not finite".to_owned()),
            },
        }
    }
}

/// A sample as points of the contour.
pub(super) enum SamplePoints {
    Single(ContactPoint),
    Several(Option<ContactPoint>, Option<ContactPoint>),
    Free,
    Nothing(String),
}

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
