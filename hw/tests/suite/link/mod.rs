//! Links, transports, counters.

mod deadlines;
mod sequence;
mod spawn;
#[cfg(feature = "rdt")]
mod udp;
