//! Contour estimates of several scans of one object: how they are offset, where they disagree, and what they tell
//! together.

mod align;
mod disagreement;
mod fuse;
mod merged;
mod nearest;
#[cfg(test)]
mod tests;

pub use align::{Offset, align};
pub use disagreement::{Comparison, Disagreement};
pub use merged::merge;
