//! The objects in lengths of the rod, and what a rod meets at their corners.

pub(crate) mod corner;
pub(crate) mod world;
