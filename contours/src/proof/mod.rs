//! Closest points, cuts and convexity that are proven from bounds of the speed and of the curvature.

pub(crate) mod curvature;
pub(crate) mod limits;
pub(crate) mod one_way;
pub(crate) mod proven;

pub use limits::Limits;
