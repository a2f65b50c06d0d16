//! Random scenes as scene files, and what came of them.

pub mod dice;
pub mod generator;
pub mod report;
pub mod shapes;
pub mod sweep;
pub mod ways;
