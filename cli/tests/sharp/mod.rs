//! Random scenes of thin, sharp, flat and finely divided objects, swept at several steps, and what came of them.

pub mod blades;
pub mod bounds;
pub mod corner;
pub mod edges;
pub mod flat;
pub mod notches;
pub mod report;
pub mod scene;
pub mod unit;
pub mod verdict;
pub mod walls;
