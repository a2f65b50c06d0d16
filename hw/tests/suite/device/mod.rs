//! Devices by their bytes.

mod gsv;
mod profile;
mod protocol;
mod record;
mod request;
#[cfg(feature = "rdt")]
mod scaling;
mod silence;
