//! Rod, objects and path of a sweep, in lengths of the rod, and what a rod meets at the objects' corners.

pub(crate) mod corner;
pub(crate) mod rod;
pub(crate) mod setup;
pub(crate) mod springs;
pub(crate) mod way;
pub(crate) mod world;
