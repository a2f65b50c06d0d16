//! The closest point of a contour, and what makes it fast: the search by samples, the parts on which it looks, and the index of many parts.

mod closest;
pub(crate) mod cuts;
mod index;
pub(crate) mod newton;
pub(crate) mod search;

pub use closest::Closest;
pub(crate) use closest::gap;
pub use index::Index;
