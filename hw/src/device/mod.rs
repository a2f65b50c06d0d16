//! Protocols of sensors.

pub mod framed;
pub mod rdt;
#[cfg(feature = "std")]
mod serial_profile;

#[cfg(feature = "std")]
pub use serial_profile::SerialProfile;
