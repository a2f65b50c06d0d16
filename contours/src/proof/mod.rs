//! Closest points, cuts and convexity that are proven from bounds of the speed and of the curvature.

pub(crate) mod bending;
pub(crate) mod branch_and_bound;
pub(crate) mod limits;

pub use limits::Limits;
