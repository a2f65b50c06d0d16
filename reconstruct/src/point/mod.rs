//! One contact from one sample: [`single`] in closed form, [`single_general`] for any law of curvature.
//!
//! `Clamp` is the rod as its clamp knows it, from pose and reactions up to the first contact; [`Touch`] is a contact point.

mod clamp;
mod moment_zero;
mod no_contact;
mod single;
#[cfg(feature = "std")]
mod single_general;
mod touch;

#[cfg(feature = "std")]
pub(crate) use clamp::Clamp;
#[cfg(feature = "std")]
pub(crate) use moment_zero::MomentZero;
pub use no_contact::NoContact;
pub use single::single;
#[cfg(feature = "std")]
pub use single_general::{GeneralError, single_general};
pub use touch::Touch;
