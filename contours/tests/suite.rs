//! The tests of the contours: one program, because each of its own links the whole library again.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod bounds;
mod composite;
mod contract;
mod frame_rates;
mod limits;
mod parabola;
mod probe;
mod shapes;
#[cfg(feature = "serde")]
mod spline_keys;
mod spline_smoothing;
mod splines;
