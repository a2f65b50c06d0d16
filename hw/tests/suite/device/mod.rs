//! Devices by their bytes.

mod engine;
mod gsv;
mod profile;
mod protocol;
mod record;
mod request;
#[cfg(feature = "rdt")]
mod scaling;
