//! One contact from one sample: [`single`] in closed form, [`one_sample`] for any rod on any clamp and with the kind of contact,
//! [`single_general`] through any integrator.
//!
//! `Clamp` is the rod as its clamp knows it, from pose and reactions up to the first contact; `friction` turns forces; `Inverse` is what a whole scan needs of a
//! rod, in closed form or step by step, for which `carried` takes numbers with derivatives along any rod; [`Touch`] is a contact point.

#[cfg(feature = "std")]
mod bent;
#[cfg(feature = "std")]
mod carried;
mod clamp;
mod friction;
#[cfg(feature = "std")]
mod inverse;
mod moment_zero;
mod no_contact;
#[cfg(feature = "std")]
mod one_sample;
mod single;
#[cfg(feature = "std")]
mod single_general;
#[cfg(feature = "std")]
mod through_roller;
mod touch;

#[cfg(feature = "std")]
pub(crate) use carried::{Carried, CrossSection, RodInterval};
#[cfg(feature = "std")]
pub(crate) use clamp::Clamp;
#[cfg(feature = "std")]
pub(crate) use friction::{normal_part, tangential};
#[cfg(feature = "std")]
pub(crate) use inverse::{Any, Inverse};
#[cfg(feature = "std")]
pub(crate) use moment_zero::{MomentZero, is_free};
pub use no_contact::NoContact;
#[cfg(feature = "std")]
pub use one_sample::{OneSample, one_sample};
pub use single::{single, single_with_friction};
#[cfg(feature = "std")]
pub use single_general::{GeneralError, single_general};
#[cfg(feature = "std")]
pub use through_roller::{Estimate, ThroughRoller, beyond_roller, through_roller};
pub use touch::Touch;
