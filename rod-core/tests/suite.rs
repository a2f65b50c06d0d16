//! The tests of the rod: one program, because each of its own links the whole library again.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod elastica;
mod kernel;
mod properties;
mod reference;
mod rods;
