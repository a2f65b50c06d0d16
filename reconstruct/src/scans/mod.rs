//! Contour estimates of several scans of one object: how they are offset, where they disagree, and what they tell
//! together.

mod align;
mod compare;
mod fuse;
mod merge;
mod nearest;
#[cfg(test)]
mod tests;

pub use align::{Offset, align};
pub use compare::{Comparison, Disagreement};
pub use merge::merge;
