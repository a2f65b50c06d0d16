//! Axes and lever arms.

mod lever_arm;
