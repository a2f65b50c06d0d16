//! One contact from one sample.

pub(crate) mod clamp;
pub(crate) mod single;
#[cfg(feature = "std")]
pub(crate) mod single_general;
pub(crate) mod touch;
