//! Lever arms.

mod lever_arm;
