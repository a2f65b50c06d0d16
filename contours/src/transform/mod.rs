//! A shape moved, reversed or trimmed, as a shape.

mod motion;
mod moved;
mod reversed;
mod trimmed;

pub use motion::Motion;
pub use moved::Moved;
pub use reversed::Reversed;
pub use trimmed::Trimmed;
