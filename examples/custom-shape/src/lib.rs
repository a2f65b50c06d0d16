//! A shape of one's own for [`vibrissa`]: [`Trochoid`], 25 lines.
//!
//! What is where: `src/trochoid.rs` the shape, `tests/contract.rs` its test, `src/main.rs` a rod swept past it
//! (`cargo run --release`). The page that leads here is `docs/add-a-shape.md` of the repository; its code is tested with
//! this package.

mod trochoid;

pub use trochoid::Trochoid;

/// The page, so that `cargo test` runs what it shows.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/add-a-shape.md")]
mod page {}
