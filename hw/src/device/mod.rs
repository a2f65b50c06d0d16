//! Devices: the protocols that sensors speak.

pub mod framed;
mod onrobot_filter;
pub mod rdt;
#[cfg(feature = "std")]
mod serial_profile;

pub use onrobot_filter::OnRobotFilter;
#[cfg(feature = "std")]
pub use serial_profile::SerialProfile;
