//! The contact as the sensor knows it: found from the pose of the clamp and the reactions alone.

use vibrissa::State;
use vibrissa::reconstruct::nalgebra::Matrix3;
use vibrissa::reconstruct::{OneSample, one_sample};
use vibrissa::rod::AnyRod;

/// Kind (`tip`, `tangent`, `several`) and place (m) of the one contact that would explain the reactions; none of a free rod. Several
/// contacts have no such place in general: the kind tells so, but for those of a uniform rod along its side, where one sample cannot.
pub fn recovered(rod: &AnyRod, state: &State) -> Option<(String, [f64; 2])> {
    let found: OneSample = one_sample(rod, state.pose, state.reactions, &Matrix3::zeros()).ok()?;
    let touch = found.touch()?;
    Some((found.to_string(), [touch.x, touch.y]))
}
