#![doc = include_str!("../README.md")]

// Not as `core`: that would hide Rust's own from whoever imports everything.
pub use {rod_contact, rod_contours, rod_core, rod_reconstruct};

// A world of its own, whose names (link, unit, step) would crowd those of the rod.
#[doc(inline)]
pub use rod_hw as hw;

#[doc(inline)]
pub use rod_contact::*;
#[doc(inline)]
pub use rod_contours::*;
#[doc(inline)]
pub use rod_core::*;
#[doc(inline)]
pub use rod_reconstruct::*;
