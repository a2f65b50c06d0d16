//! Links, transports, counters.

mod engine;
mod sequence;
mod spawn;
#[cfg(feature = "rdt")]
mod udp;
