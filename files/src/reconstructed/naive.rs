//! Contact points as if every sample had a single contact.

use nalgebra::Matrix3;
use vibrissa::Sample;
use vibrissa::reconstruct::{Touch, one_sample, single};
use vibrissa::rod::AnyRod;

/// The contact point of a sample as if it were a single one: where the moment vanishes first. For a uniform rod the pose is that of the base,
/// for another one that of the support.
pub fn naive_touch(rod: &AnyRod, sample: &Sample) -> Option<Touch> {
    let (Sample { pose, reactions, .. }, exact) = (*sample, Matrix3::zeros());
    match rod.uniform() {
        Some(rod) => single(rod, pose, reactions, &exact).map_or_else(|none| none.touch(), Some),
        None => one_sample(rod, pose, reactions, &exact).ok()?.touch(),
    }
}
