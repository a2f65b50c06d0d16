//! The tests of the inversion: one program, because each of its own links the whole library again.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod clean;
mod common;
mod frames;
mod frames_at_a_pole;
mod free_rod;
mod friction;
mod kink_filter;
mod kinks;
mod kinks_of_the_paper;
mod live_labels;
mod noise;
mod noise_estimate;
mod plausibility;
mod poses;
mod properties;
mod single_precision;
mod two_contacts;
