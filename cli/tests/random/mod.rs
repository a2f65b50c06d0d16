//! Random scenes as scene files, and a judge of what comes out that shares no code with the solver.
#![allow(dead_code, reason = "the two tests take what they need")]

pub mod dice;
pub mod generator;
pub mod judge;
pub mod outline;
pub mod report;
pub mod rod;
pub mod shapes;
pub mod sweep;
pub mod ways;
