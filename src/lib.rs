//! A flexible rod that touches things.
pub use rod_contact as contact;
pub use rod_contact::*;
pub use rod_contours as contours;
pub use rod_contours::*;
pub use rod_core as core;
pub use rod_core::*;
