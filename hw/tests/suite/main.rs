//! Sensors and recordings without a device: known bytes, damaged streams, fake devices, files as they end up on a disk.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod calibrate;
mod chain;
mod chain_parts;
mod device;
mod framed;
mod link;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(all(feature = "serial", unix))]
mod pty;
#[cfg(feature = "rdt")]
mod rdt;
#[cfg(feature = "recordings")]
mod recording;
mod support;
