//! Contour estimates of several scans of one object: their offsets, where they disagree, and the contour from all of them.

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
