//! Transitions of random scenes with all kinds of rods, clamps, laws of friction and shapes, judged by code that knows nothing of the solver.

mod frames;
mod judge;
mod laws;
mod scene;
