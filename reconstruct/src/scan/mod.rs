//! A scan: its samples in order along the path of the clamp, their noise, and smooth local fits of the reactions.

pub(crate) mod local_cubic;
pub mod noise_estimate;
pub(crate) mod track;
pub(crate) mod travel;
