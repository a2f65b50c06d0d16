//! The tests of the whole: one program, because each of its own links the whole library again.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod allocation;
mod cart;
mod common;
mod convergence;
mod derivatives;
mod equilibrium;
mod fit;
mod flat;
mod follow_contour;
mod friction;
mod hard;
mod hard_cases;
mod hard_starts;
mod inadmissible;
mod inflection;
#[cfg(feature = "serde")]
mod json;
mod paths;
mod phase_criterion;
mod reference;
mod reference_set;
mod regression;
mod rods;
mod size;
mod symmetry;
mod threads;
mod transitions;
