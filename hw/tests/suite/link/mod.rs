//! Links, transports, counters.

mod engine;
mod sequence;
#[cfg(feature = "rdt")]
mod udp;
