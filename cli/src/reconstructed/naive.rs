//! Contact points as if every sample had a single contact.

use nalgebra::Matrix3;
use vibrissa::Rod;
use vibrissa::reconstruct::{Touch, single};

/// The contact point of a sample if it had a single contact.
pub(crate) fn naive_touch(rod: &Rod, sample: &vibrissa::Sample) -> Option<Touch> {
    single(rod, sample.pose, sample.reactions, &Matrix3::zeros()).map_or_else(|none| none.touch(), Some)
}
