//! A sample as contours are assembled from it.

use super::point::ContactPoint;
use crate::phase::Label;
use crate::point::Touch;

/// One sample of a scan as contours are assembled from it: its contact phase and its contact points.
///
/// A sample with several contacts has its first contact, or the first and the second; a sample with one contact has that one; a
/// sample without contact points has the reason, if there is one.
///
/// ```
/// use rod_reconstruct::{Label, Measured};
/// let lost = Measured { reason: Some("the rod is shorter than that"), ..Measured::new(Label::B, &[]) };
/// assert!(lost.touches.is_empty() && Measured::free().label == Label::Free);
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
    /// A sample of a rod that touches nothing.
    pub fn free() -> Self {
        Self { label: Label::Free, touches: &[], reason: None, shared: 1 }
    }

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
