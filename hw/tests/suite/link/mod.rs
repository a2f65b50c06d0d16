//! Links, transports, counters.

mod engine;
mod read_write;
mod sequence;
#[cfg(feature = "rdt")]
mod udp;
