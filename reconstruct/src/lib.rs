//! From what the clamp feels back to the object: contact points, contact phases, contours.
//!
//! - [`Sample`]: clamp pose and reactions at one instant; [`Label`]: in which contact phase it was.
//!
//! This crate knows reactions, not sensors, and nothing of how a rod is swept: what it is told is where the clamp was and
//! what it felt. Units are SI at its border, dimensionless inside (lengths in L, forces in EI/L^2, moments in EI/L).
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

#[allow(dead_code, reason = "the identification of phases is to call it")]
mod beyond;
#[allow(dead_code, reason = "the identification of phases is to call it")]
mod envelope;
#[allow(dead_code, reason = "the identification of phases is to call it")]
mod fit;
mod known;
mod label;
mod sample;
#[allow(dead_code, reason = "the identification of phases is to call it")]
mod several;
mod single;
mod touch;

pub use label::Label;
pub use sample::Sample;
pub use several::Unresolved;
pub use single::{NoContact, single};
pub use touch::Touch;
